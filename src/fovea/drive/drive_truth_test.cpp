#include "fovea/drive/drive_truth.h"

#include <gmock/gmock.h>

#include "../../../tests/kitti_test_drive.h"
#include "../../../tests/truth_writer.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"

namespace fovea::drive_truth_test {

using test::edit;
using test::error_of;
using test::write_text;
using test::fs::path;
using testing::ElementsAre;
using testing::HasSubstr;

Camera small_camera(int index) {
  Camera camera{index, 5, 4, 5, 5, 2, 1.5, RigidMotion::Identity()};
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera.T_cam_lidar.translation().x() = -0.1 * index;
  return camera;
}

std::vector<RigidMotion> poses(int frames) {
  std::vector<RigidMotion> T_local_lidar;
  for (int i = 0; i < frames; ++i) {
    T_local_lidar.push_back(RigidMotion(Eigen::Translation3d(0.1 * i, 1.0 / 3, -2)));
  }
  return T_local_lidar;
}

class DriveTruthFiles : public testing::Test {
 protected:
  void SetUp() override {
    test::write_truth_poses(truth_, {49.01, 8.43, 114.5}, poses(3),
                            {small_camera(2), small_camera(3)});
    TrueReturn hit;
    hit.hit_lidar = {1.5f, -2, 0.25f};
    hit.time = -0.03f;
    hit.surface = 4'000'000'000u;
    hit.albedo = {1, 128, 255};
    hit.ring = 63;
    hit.moving = true;
    test::write_file(truth_ / "velodyne_points/0000000001.bin",
                     test::return_records({TrueReturn{Eigen::Vector3f(9, 8, 7)}, hit}));
    test::write_png_file(truth_ / "image_03/perfect/0000000001.png", test::pattern(5, 4, 3));
    for (int i = 0; i < 20; ++i) depth_.depth.push_back(float(i * i * 181) / 256.0f);
    test::write_depth_png(truth_ / "image_03/depth/0000000001.png", depth_);
  }

  std::string error() const {
    return error_of<InputError>([&] { const DriveTruth read(drive_.path()); });
  }

  TemporaryFolder drive_;
  path truth_ = drive_ / "truth";
  DepthImage depth_{5, 4, {}};
};

TEST_F(DriveTruthFiles, GiveWhatWasWritten) {
  const DriveTruth truth(drive_.path());
  EXPECT_EQ(truth.frames(), 3);
  EXPECT_EQ(truth.scene(), "street");
  EXPECT_EQ(truth.sweep_period(), 0.1);
  EXPECT_EQ(truth.origin().latitude, 49.01);
  EXPECT_EQ(truth.origin().longitude, 8.43);
  EXPECT_EQ(truth.origin().altitude, 114.5);
  EXPECT_THAT(truth.camera_numbers(), ElementsAre(2, 3));
  EXPECT_EQ(truth.T_local_lidar()[2].matrix(), poses(3)[2].matrix());
  const RigidMotion T_local_cam = poses(3)[1] * small_camera(3).T_cam_lidar.inverse();
  EXPECT_TRUE(truth.camera(3).T_local_cam[1].isApprox(T_local_cam, 1e-14));
  EXPECT_THAT(truth.camera(2).exposure, ElementsAre(1, 1, 1));

  const std::vector<TrueReturn> returns = truth.returns(1);
  ASSERT_EQ(returns.size(), 2u);
  EXPECT_EQ(returns[0].hit_lidar, Eigen::Vector3f(9, 8, 7));
  EXPECT_FALSE(returns[0].moving);
  EXPECT_EQ(returns[1].hit_lidar, Eigen::Vector3f(1.5f, -2, 0.25f));
  EXPECT_EQ(returns[1].time, -0.03f);
  EXPECT_EQ(returns[1].surface, 4'000'000'000u);
  EXPECT_EQ(returns[1].albedo, (Rgb{1, 128, 255}));
  EXPECT_EQ(returns[1].ring, 63);
  EXPECT_TRUE(returns[1].moving);
}

TEST_F(DriveTruthFiles, ImagesAndDepthsAreReadExactly) {
  const DriveTruth truth(drive_.path());
  EXPECT_EQ(truth.perfect_image(3, 1).data, test::pattern(5, 4, 3).data);
  const DepthImage depth = truth.depth(3, 1);
  EXPECT_EQ(depth.width, 5);
  EXPECT_EQ(depth.height, 4);
  EXPECT_EQ(depth.depth, depth_.depth);
  EXPECT_EQ(depth.at(4, 3), 361 * 181 / 256.0f);
}

TEST_F(DriveTruthFiles, AreMissedByName) {
  const DriveTruth truth(drive_.path());
  EXPECT_THAT(error_of<InputError>([&] { truth.returns(2); }), HasSubstr("0000000002.bin"));
  EXPECT_THAT(error_of<InputError>([&] { truth.perfect_image(2, 0); }), HasSubstr("perfect"));
  EXPECT_THAT(error_of<InputError>([&] { truth.depth(2, 0); }), HasSubstr("depth"));
  EXPECT_THAT(error_of<InputError>([&] { truth.camera(0); }), HasSubstr("camera 0"));
  for (const char* name :
       {"image_03/exposure.txt", "image_02/poses.txt", "poses.txt", "truth.json"}) {
    test::fs::remove(truth_ / name);
    EXPECT_THAT(error(), HasSubstr((truth_ / name).string()));
  }
  test::fs::remove_all(truth_);
  EXPECT_THAT(error(), testing::AllOf(HasSubstr("no truth"), HasSubstr("fovea simulate")));
}

TEST_F(DriveTruthFiles, DamageIsNamed) {
  edit(truth_ / "truth.json", "\"frames\": 3", "\"frames\": 4");
  EXPECT_THAT(error(), HasSubstr("3 lines for 4 frames"));
  edit(truth_ / "truth.json", "\"version\": 1", "\"version\": 2");
  EXPECT_THAT(error(), HasSubstr("newer Fovea"));
  edit(truth_ / "truth.json", "\"version\": 2", "\"version\": 1e300");
  EXPECT_THAT(error(), HasSubstr("a whole number is none"));
  edit(truth_ / "truth.json", "\"version\"", "\"verse\"");
  EXPECT_THAT(error(), HasSubstr("damaged"));
  write_text(truth_ / "truth.json", "{");
  EXPECT_THAT(error(), HasSubstr("damaged"));
}

TEST_F(DriveTruthFiles, DamagedExposuresScansAndDepthsAreNamed) {
  const DriveTruth truth(drive_.path());
  write_text(truth_ / "image_02/exposure.txt", "1\n0\n1\n");
  EXPECT_THAT(error(), HasSubstr("exposure.txt:2"));
  test::truncate(truth_ / "velodyne_points/0000000001.bin", 0.9);
  EXPECT_THAT(error_of<InputError>([&] { truth.returns(1); }), HasSubstr("no multiple of the 28"));
  TrueReturn bad;
  bad.hit_lidar = {1, NAN, 1};
  test::write_file(truth_ / "velodyne_points/0000000001.bin", test::return_records({bad}));
  EXPECT_THAT(error_of<InputError>([&] { truth.returns(1); }), HasSubstr("not finite"));
  const path depth = truth_ / "image_03/depth/0000000001.png";
  test::truncate(depth, 0.7);
  EXPECT_THAT(error_of<InputError>([&] { truth.depth(3, 1); }), HasSubstr(depth.string()));
  test::write_png_file(depth, test::pattern(5, 4, 1));
  EXPECT_THAT(error_of<InputError>([&] { truth.depth(3, 1); }), HasSubstr("16 bits"));
}

}  // namespace fovea::drive_truth_test
