#include "fovea/pipeline/view_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/errors.h"

namespace fovea {
namespace {

bool sees_any(const Camera& camera, const PointCloud& scan_lidar) {
  return std::any_of(
      scan_lidar.position.begin(), scan_lidar.position.end(), [&](const Eigen::Vector3f& p_lidar) {
        const auto pixel = camera.project(camera.T_cam_lidar * p_lidar.cast<double>());
        return pixel && camera.in_view(*pixel);
      });
}

}  // namespace

ViewCheck::ViewCheck(const DriveInfo& drive)
    : drive_(drive), sees_(drive.calibration.cameras.size(), false) {}

void ViewCheck::add(const PointCloud& scan_lidar) {
  if (scans_ >= kMaxScans) return;
  ++scans_;
  for (std::size_t k = 0; k < sees_.size(); ++k) {
    if (!sees_[k]) sees_[k] = sees_any(drive_.calibration.cameras[k], scan_lidar);
  }
  if (scans_ == kMaxScans) require_view();
}

void ViewCheck::require_view() const {
  if (passed()) return;
  throw InputError(
      fmt::format("no camera sees a point of {} scan{}", scans_, scans_ == 1 ? "" : "s"),
      drive_.path.string(), "correct the cameras' places: T_cam_lidar may be given as T_lidar_cam");
}

bool ViewCheck::passed() const {
  return sees_.empty() || std::find(sees_.begin(), sees_.end(), true) != sees_.end();
}

void ViewCheck::skip() {
  std::fill(sees_.begin(), sees_.end(), true);
  scans_ = kMaxScans;
}

std::vector<std::string> ViewCheck::notes() const {
  std::vector<std::string> notes;
  for (std::size_t k = 0; k < sees_.size(); ++k) {
    if (sees_[k]) continue;
    notes.push_back(
        fmt::format("camera {} sees no point of {} scans: check its place (T_cam_lidar)",
                    drive_.calibration.cameras[k].index, scans_));
  }
  return notes;
}

}  // namespace fovea
