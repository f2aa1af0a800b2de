#include "fovea/exporting/views/nerf_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "../../../../tests/file_content.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/exporting/views/view_test_map.h"

namespace fovea::nerf_writer_test {

using testing::ElementsAre;
using view_test::camera_of;

class NerfWriter : public testing::Test {
 protected:
  nlohmann::json write(const std::vector<Camera>& cameras) const {
    view_test::write_map(folder_ / "a.fovea", cameras);
    write_nerf(MapReader(folder_ / "a.fovea"), folder_ / "a.fovea", folder_ / "out", {});
    return nlohmann::json::parse(content(folder_ / "out" / "transforms.json"));
  }
  TemporaryFolder folder_;
};

/// As instant-ngp and nerfstudio read it: camera to world; x right, y up, and the camera looks
/// along -z.
Eigen::Vector2d pixel_of(const Eigen::Vector3d& p, const nlohmann::json& intrinsics,
                         const nlohmann::json& matrix) {
  Eigen::Matrix4d T_world_cam;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) T_world_cam(row, column) = matrix[row][column];
  }
  const Eigen::Vector4d p_cam = T_world_cam.inverse() * p.homogeneous();
  EXPECT_LT(p_cam.z(), 0);
  return {double(intrinsics["fl_x"]) * p_cam.x() / -p_cam.z() + double(intrinsics["cx"]),
          double(intrinsics["fl_y"]) * -p_cam.y() / -p_cam.z() + double(intrinsics["cy"])};
}

TEST_F(NerfWriter, PointsProjectWhereTheCamerasOfTheMapShowThem) {
  const std::vector<Camera> cameras = {camera_of(2, 500), camera_of(3, 700)};
  const nlohmann::json json = write(cameras);
  EXPECT_FALSE(json.contains("fl_x"));
  ASSERT_EQ(json["frames"].size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const nlohmann::json& frame = json["frames"][i];
    EXPECT_EQ(frame["w"], 640);
    for (const Eigen::Vector3d& p : view_test::kPoints) {
      const Eigen::Vector2d pixel = pixel_of(p, frame, frame["transform_matrix"]);
      const Eigen::Vector2d expected = view_test::pixel_of(p, cameras[i / 3], int(i % 3));
      // Pixel centers are at 0.5 there, ours at integers.
      EXPECT_LT((pixel - Eigen::Vector2d(0.5, 0.5) - expected).norm(), 1e-3);
    }
  }
}

TEST_F(NerfWriter, OneCameraIsStatedOnceAndHeldOutFramesAreTheTest) {
  const nlohmann::json json = write({camera_of(2, 500)});
  EXPECT_EQ(json["fl_x"], 500);
  EXPECT_EQ(json["cx"], 310.75);
  EXPECT_FALSE(json["frames"][0].contains("fl_x"));
  EXPECT_THAT(json["train_filenames"],
              ElementsAre("images/camera_2_0000000000.png", "images/camera_2_0000000002.png"));
  EXPECT_THAT(json["test_filenames"], ElementsAre("images/camera_2_0000000001.png"));
  EXPECT_EQ(json["val_filenames"], json["test_filenames"]);
}

TEST_F(NerfWriter, ThePointsLieInAPlyFile) {
  const nlohmann::json json = write({camera_of(2, 500)});
  const std::string ply = content(folder_ / "out" / std::string(json["ply_file_path"]));
  EXPECT_THAT(ply, testing::HasSubstr("element vertex 3\n"));
  const std::string end = "end_header\n";
  const std::string bytes = ply.substr(ply.find(end) + end.size());
  ASSERT_EQ(bytes.size(), 3 * 15u);
  float position[3];
  std::memcpy(position, bytes.data() + 15, sizeof(position));
  EXPECT_THAT(position, ElementsAre(2, 1, 1));
  EXPECT_EQ(bytes.substr(27, 3), "\x01\x02\x03");
}

}  // namespace fovea::nerf_writer_test
