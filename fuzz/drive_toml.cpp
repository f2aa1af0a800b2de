// drive.toml: the calibration of any drive, and the pinhole cameras in its lenses; the correction
// of a calibrated drive.
#include <cmath>

#include "fovea/drive/drive_correction.h"
#include "fovea/drive/drive_description.h"
#include "fovea/geometry/rectified_camera.h"
#include "fuzz_input.h"

using namespace fovea;

namespace {

constexpr int kMaxSide = 1024;  // of the images that are rectified here: the rest takes too long

void check_place(int camera, const RigidMotion& T_cam_lidar) {
  require(camera >= 0 && camera <= 9, "cameras have numbers that maps can hold");
  require(is_rotation(T_cam_lidar.linear(), 1e-9), "cameras are turned by rotations");
  require(T_cam_lidar.translation().norm() <= 20.1, "cameras are on the vehicle");
}

void check(const CameraDescription& camera) {
  check_place(camera.index, camera.T_cam_lidar);
  if (camera.optics.width > kMaxSide || camera.optics.height > kMaxSide) return;
  const auto pinhole = rectified_camera(camera.optics, camera.max_field_of_view, kMaxSide);
  if (!pinhole) return;
  require(pinhole->width <= kMaxSide && pinhole->height <= kMaxSide, "images are not too large");
  require(pinhole->width > 0 && pinhole->height > 0, "images are not empty");
  for (const int u : {0, pinhole->width / 2, pinhole->width - 1}) {
    const Eigen::Vector3d ray((u - pinhole->cx) / pinhole->fx, -pinhole->cy / pinhole->fy, 1);
    if (camera.optics.lens.model() == LensModel::kNone) break;
    const auto pixel = camera.optics.project(ray);
    require(pixel && camera.optics.in_view(*pixel), "the border of a rectified image is seen");
  }
}

/// What is read and written is read as the same.
void check_correction(const SettingsDocument& document) {
  const CalibratedDrive read = parse_calibrated_drive(document);
  const DriveCorrection& correction = read.correction;
  require(correction.cameras.size() <= 10, "there are ten cameras at most");
  for (const DriveCorrection::CorrectedCamera& camera : correction.cameras) {
    check_place(camera.camera, camera.T_cam_lidar);
    require(std::abs(camera.added_delay) <= 1, "a delay is short");
  }
  const CalibratedDrive again =
      parse_calibrated_drive(SettingsDocument::from_text(calibrated_drive_text(read), "again"));
  require(again.drive == read.drive, "the path comes back");
  require(again.correction.cameras.size() == correction.cameras.size(), "cameras come back");
  require(again.correction.imu.has_value() == correction.imu.has_value(), "the IMU comes back");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read_or_refuse<ConfigError>([&] {
    const auto document = SettingsDocument::from_text(as_text(data, size), "drive.toml");
    if (is_calibrated_drive(document)) return check_correction(document);
    const DriveDescription drive = parse_drive_description(as_text(data, size), "drive.toml");
    require(drive.cameras.size() <= 10, "there are ten cameras at most");
    require(drive.lidar.sweep.stamp_phase.value_or(0) >= 0, "the stamp is in the sweep");
    for (const LidarDescription& lidar : drive.further_lidars) {
      require(lidar.T_lidar_sensor.matrix().allFinite(), "a LiDAR is somewhere");
    }
    require(drive.antenna_body.allFinite(), "the antenna is somewhere");
    for (const CameraDescription& camera : drive.cameras) check(camera);
  });
  return 0;
}
