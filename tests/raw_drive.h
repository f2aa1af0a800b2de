// A drive whose vehicle is under way when it begins, and whose sweeps show it: for tests.
#pragma once

#include <set>

#include "synthetic_drive.h"

namespace fovea {

/// A drive without navigation at a constant velocity whose scans are raw (or compensated, if
/// the drive is made to say so): each point where the LiDAR of its moment saw it. `dropped` frames
/// have no scan.
class RawDrive : public SyntheticDrive {
 public:
  std::set<int> dropped;

  RawDrive(int frames, const Twist& velocity)
      : SyntheticDrive(town_scene(), frames, 0), velocity_(velocity) {
    for (int i = 0; i < frames; ++i) T_local_lidar[std::size_t(i)] = exp_se3(0.1 * i * velocity);
    DriveInfo& info = editable_info();
    info.navigation.reset();
    info.sweep_compensated = false;
    info.sweep.period = 0.1;
  }

  LoadedFrame load(int index) const override {
    if (dropped.contains(index)) return SkippedFrame{index, SkipReason::kMissingScan, "no scan"};
    LoadedFrame result = SyntheticDrive::load(index);
    if (info().sweep_compensated) return result;
    PointCloud& scan = std::get<Frame>(result).scan;
    for (Eigen::Vector3f& p : scan.position) {
      const double dt = -std::atan2(p.y(), p.x()) / (2 * std::numbers::pi) * 0.1;
      scan.time.push_back(static_cast<float>(dt));
      p = (exp_se3(-dt * velocity_) * p.cast<double>()).cast<float>();
    }
    return result;
  }

 private:
  Twist velocity_;
};

}  // namespace fovea
