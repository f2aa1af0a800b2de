#include "fovea/pipeline/calibration_check.h"

#include <algorithm>

#include "fovea/pipeline/scan_edges.h"

namespace fovea {
namespace {

/// Frames of a live drive, whose length is not known: the check ends after a minute at 10 Hz.
constexpr int kLiveStride = 30;

std::vector<EdgeProfile> profiles_of(const Frame& frame, std::size_t slot, const Camera& camera,
                                     const DriveInfo& drive, bool compensate,
                                     const FrameMotion& motion) {
  if (frame.images.at(slot).empty()) return {};
  const auto sweep = compensate ? std::optional(motion.sweep) : std::nullopt;
  return profiles_of_lidars(scan_edges(frame.scan, camera, drive, sweep), frame.images.at(slot),
                            {camera, motion.sweep.velocity, motion.T_local_lidar, frame.index});
}

}  // namespace

CalibrationCheck::CalibrationCheck(const DriveInfo& drive, bool compensate, bool is_live,
                                   std::optional<int> begin)
    : drive_(drive),
      compensate_(compensate),
      checks_imu_(drive.imu && !is_live),
      stride_(is_live ? kLiveStride
                      : std::max(kMinStride, (int(drive.frame_count()) + kFrames - 1) / kFrames)),
      next_(begin.value_or(drive.begin) + stride_ / 2),
      profiles_(drive.calibration.cameras.size()) {}

void CalibrationCheck::add_edges(const Frame& frame, const FrameMotion& motion) {
  next_ = frame.index + stride_;
  ++used_;
  for (std::size_t k = 0; k < profiles_.size(); ++k) {
    const auto profiles =
        profiles_of(frame, k, camera_of(drive_, frame, k), drive_, compensate_, motion);
    profiles_[k].insert(profiles_[k].end(), profiles.begin(), profiles.end());
  }
}

DriveCalibration CalibrationCheck::estimate() const {
  DriveCalibration found;
  for (std::size_t k = 0; k < profiles_.size(); ++k) {
    found.cameras.push_back(
        {drive_.calibration.cameras[k].index, estimate_calibration(profiles_[k])});
  }
  if (checks_imu_) found.imu = imu_.estimate(*drive_.imu);
  return found;
}

}  // namespace fovea
