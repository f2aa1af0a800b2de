#include "fovea/simulation/generic_simulation_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "../../../tests/temporary_folder.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"
#include "fovea/simulation/drive_texts.h"
#include "fovea/simulation/simulate.h"

namespace fovea::generic_simulation_writer_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// A small drive with five cameras all round, each with a lens of another kind, whose calibration
/// has a fault that its truth has not.
SimulationOptions around() {
  SimulationOptions options = simulation_options(Scene::kStreet, "none");
  options.format = DriveFormat::kGeneric;
  options.frames = 2;
  options.lidar.columns = 240;
  options.camera.width = 240;
  options.camera.height = 120;
  options.camera.focal = 140;
  options.camera.cx = 121.5;
  options.camera.cy = 57.25;
  options.camera.rig = CameraRig::kSurround;
  options.camera.cameras = rig_cameras(CameraRig::kSurround);
  options.camera.cameras[2].lens = SimulatedLens::kRational;
  options.camera.rotation_error = {0.01, 0.02, -0.01};
  return options;
}

std::unique_ptr<FrameSource> open_all(const std::filesystem::path& drive) {
  DriveOptions options;
  options.cameras = {0, 1, 2, 3, 4};
  return open_drive(drive, options);
}

std::string config_error(const SimulationOptions& options) {
  try {
    options.validate();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no ConfigError";
}

/// Mean difference of grey values, of an image against another that is moved by some pixels.
double mean_difference(const Image& a, const Image& b, int dx, int dy) {
  double sum = 0;
  int count = 0;
  for (int v = 1; v + 1 < a.height; ++v) {
    for (int u = 1; u + 1 < a.width; ++u) {
      for (int c = 0; c < a.channels; ++c) {
        sum += std::abs(int(a.pixel(u, v)[c]) - int(b.pixel(u + dx, v + dy)[c]));
        ++count;
      }
    }
  }
  return sum / count;
}

/// The drive, written once.
class GenericSimulation : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    EXPECT_EQ(simulate(around(), path()), path());
  }
  static void TearDownTestSuite() { delete scratch_; }
  static std::filesystem::path path() { return *scratch_ / "d"; }

 private:
  static TemporaryFolder* scratch_;
};
TemporaryFolder* GenericSimulation::scratch_ = nullptr;

TEST_F(GenericSimulation, TheReaderFindsTheRigAndWhatItRecorded) {
  const SimulationOptions options = around();
  const auto drive = open_all(path());
  EXPECT_THAT(drive->info().notes, IsEmpty());
  const Rig rig = make_rig(options);
  for (std::size_t k = 0; k < 5; ++k) {
    const Camera& camera = drive->info().calibration.cameras[k];
    EXPECT_TRUE(camera.T_cam_lidar.isApprox(rig.T_cam_lidar_calibrated[k], 1e-14));
    EXPECT_FALSE(camera.T_cam_lidar.isApprox(rig.cameras[k].T_cam_lidar, 1e-3));
    EXPECT_EQ(camera.width, rig.cameras[k].width);
    EXPECT_EQ(camera.cx, rig.cameras[k].cx);
    // Counter-clockwise seen from above, a fifth of a turn each.
    const Eigen::Vector3d ahead = camera.T_cam_lidar.inverse().linear() * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(
        std::remainder(std::atan2(ahead.y(), ahead.x()) - double(k) * 72 * kDegree, 360 * kDegree),
        0, 2 * kDegree);
  }
  for (const StampedPose& pose : drive->info().navigation->poses()) {
    EXPECT_GT(pose.velocity.value().tail<3>().norm(), 1);
  }
  const Frame frame = std::get<Frame>(drive->load(1));
  EXPECT_EQ(frame.stamp, stamp_of(1, options));
  const std::vector<TrueReturn> returns = DriveTruth(path()).returns(1);
  ASSERT_EQ(frame.scan.size(), returns.size());
  for (std::size_t i = 0; i < returns.size(); ++i) {
    EXPECT_EQ(frame.scan.time[i], returns[i].time);
  }
}

TEST_F(GenericSimulation, RectifiedImagesAreWhatAPerfectPinholeCameraSees) {
  const auto drive = open_all(path());
  const DriveTruth truth(path());
  const Frame frame = std::get<Frame>(drive->load(1));
  for (int camera = 0; camera < 5; ++camera) {
    const Image &image = frame.images[std::size_t(camera)],
                perfect = truth.perfect_image(camera, 1);
    ASSERT_EQ(image.width, perfect.width);
    ASSERT_EQ(image.height, perfect.height);
    const double there = mean_difference(image, perfect, 0, 0);
    if (camera == 0 || camera == 3) {
      EXPECT_EQ(there, 0);
      continue;
    }
    // Edges and texture are drawn anew on another grid of pixels, in the same place.
    EXPECT_LT(there, 5) << camera;
    for (const auto& [dx, dy] :
         {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
      EXPECT_LT(there, 0.75 * mean_difference(image, perfect, dx, dy)) << camera;
    }
  }
}

TEST_F(GenericSimulation, KittisFormatHasNeitherTurnedCamerasNorLenses) {
  SimulationOptions options = around();
  options.format = DriveFormat::kKitti;
  EXPECT_THAT(config_error(options), AllOf(HasSubstr("KITTI"), HasSubstr("--format generic")));
  options = SimulationOptions();
  options.camera.cameras[0].lens = SimulatedLens::kPlumbBob;
  EXPECT_THAT(config_error(options), HasSubstr("camera 2"));
  options.format = DriveFormat::kGeneric;
  EXPECT_NO_THROW(options.validate());
}

TEST_F(GenericSimulation, LensesThatDoNotReachTheCornersAreRefused) {
  SimulationOptions options = around();
  options.camera.focal = 30;
  EXPECT_THAT(config_error(options), AllOf(HasSubstr("corners"), HasSubstr("camera.lens_")));
}

}  // namespace fovea::generic_simulation_writer_test
