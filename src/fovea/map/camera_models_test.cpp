#include "fovea/map/camera_models.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::camera_models_test {

Camera sample_camera(int index) {
  Camera camera;
  camera.index = index;
  camera.width = 1242, camera.height = 375;
  camera.fx = 721.5377, camera.fy = 720.1, camera.cx = 609.5593, camera.cy = 1.0 / 3;
  camera.image_delay = -0.0125;
  camera.T_cam_lidar = exp_se3((Twist() << 0.3, -1.2, 0.9, 0.06, -0.08, 1.0 / 7).finished());
  return camera;
}

TEST(CameraModels, ReadBackToTheSameNumbers) {
  MapMeta meta;
  store_camera_models({sample_camera(3), sample_camera(2)}, 1, meta);
  EXPECT_TRUE(camera_models(meta, 0).empty());
  const std::vector<Camera> cameras = camera_models(meta, 1);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].index, 2);
  const Camera expected = sample_camera(3), &read = cameras[1];
  EXPECT_EQ(read.index, 3);
  EXPECT_EQ(read.width, expected.width);
  EXPECT_EQ(read.height, expected.height);
  EXPECT_EQ(Eigen::Vector4d(read.fx, read.fy, read.cx, read.cy),
            Eigen::Vector4d(expected.fx, expected.fy, expected.cx, expected.cy));
  EXPECT_EQ(read.image_delay, expected.image_delay);
  EXPECT_EQ(read.T_cam_lidar.matrix(), expected.T_cam_lidar.matrix());
}

TEST(CameraModels, AnythingElseIsAnError) {
  MapMeta meta;
  store_camera_models({sample_camera(2)}, 0, meta);
  const std::string text = meta.at("camera_model.0.2");
  const std::string rest = text.substr(text.find(' '));
  for (const std::string& damaged :
       {std::string(), std::string("camera"), text + " 1", "1e9" + rest, "-1" + rest, "1.5" + rest,
        std::string("9 9 0 7 4 4 0 1 0 0 0 0 1 0 0 0 0 1 0"),
        std::string("9 9 7 7 4 4 0 1 0 0 0 0 1 0 0 0 0 0 0")}) {
    meta["camera_model.0.2"] = damaged;
    EXPECT_THROW(camera_models(meta, 0), InputError) << damaged;
  }
  Camera camera = sample_camera(2);
  camera.fx = std::numeric_limits<double>::infinity();
  EXPECT_THROW(store_camera_models({camera}, 0, meta), std::invalid_argument);
}

TEST(CameraModels, ChangeNeitherDigestNorIdentity) {
  const TemporaryFolder folder;
  std::vector<std::string> digests, identities;
  for (const bool is_stated : {false, true}) {
    MapMeta meta;
    if (is_stated) store_camera_models({sample_camera(2)}, 0, meta);
    const auto writer = MapWriter::create(folder / "a.fovea", /*force=*/true);
    writer->put_meta("drive.name", "street");
    for (const auto& [key, value] : meta) writer->put_meta(key, value);
    writer->finish();
    const MapReader map(folder / "a.fovea");
    EXPECT_EQ(camera_models(map.meta(), 0).size(), meta.size());
    digests.push_back(map.digest());
    identities.push_back(map.identity());
  }
  EXPECT_EQ(digests[0], digests[1]);
  EXPECT_EQ(identities[0], identities[1]);
}

}  // namespace fovea::camera_models_test
