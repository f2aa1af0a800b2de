// Likely causes of differences between navigation and scans: errors of units, order and direction.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/drive/navigation/navigation_repairs.h"

namespace fovea {

/// Compares navigation with registered scans over a drive. If they differ, it removes each known
/// error from navigation. An error whose removal makes navigation agree with the scans is a likely
/// cause.
///
///     NavigationFaults faults(drive);
///     for (const auto& [T_local_lidar, T_odom_lidar] : frames) faults.add(T_local_lidar,
///     T_odom_lidar); if (const auto cause = faults.likely_cause()) notes.push_back(*cause);
class NavigationFaults {
 public:
  /// @param drive  must outlive the faults
  explicit NavigationFaults(const DriveInfo& drive) : drive_(drive) {}

  /// Adds the next frame.
  /// @param T_local_lidar  by navigation
  /// @param T_odom_lidar   by registration
  void add(const RigidMotion& T_local_lidar, const RigidMotion& T_odom_lidar);
  /// Joins no step across a frame without navigation or registration.
  void interrupt() { is_interrupted_ = true; }

  /// A note that names the likely causes. Empty if navigation agrees with the scans, if the vehicle
  /// has hardly moved, or if no known error explains the difference.
  std::optional<std::string> likely_cause() const;

 private:
  struct Sample {
    RigidMotion T_local_lidar;  // by navigation
    RigidMotion T_odom_lidar;   // by registration
    bool is_joined = false;     // to the last sample, without a gap in navigation or scans
  };
  static NavigationStep step_between(const Sample& first, const Sample& last);
  /// Steps from each sample to the next.
  NavigationSteps steps() const;
  /// Steps from samples to the next one with another direction.
  NavigationSteps turns() const;

  const DriveInfo& drive_;
  std::vector<Sample> samples_;
  bool is_interrupted_ = true;  // since the last sample
};

}  // namespace fovea
