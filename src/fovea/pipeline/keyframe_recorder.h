// Range images of some of the scans, which the map keeps: other maps are aligned to them, and they
// show free space (docs/map-format.md).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/map/map_records.h"
#include "fovea/pipeline/frame_pipeline.h"

namespace fovea {

/// What each LiDAR sees in a scan, one range image each. Of the returns in a cell, the one nearest
/// to its center counts: walls stay plane.
/// @param scan_lidar  motion compensated to the stamp of the frame
std::vector<KeyframeRecord> range_images(const PointCloud& scan_lidar, const DriveInfo& drive,
                                         int frame);

/// Chooses the keyframes: the first mapped frame of each submap, and then one at each `spacing`.
/// Depends only on the frames so far.
class KeyframeRecorder {
 public:
  /// @param spacing  m; 0: there are no keyframes
  /// @param drive    must outlive the recorder
  KeyframeRecorder(double spacing, const DriveInfo& drive) : spacing_(spacing), drive_(drive) {}

  /// Takes the range images of a tracked frame if it is a keyframe.
  void add(const TrackedFrame& tracked);
  /// A frame of an earlier run, whose range images are in the map.
  void add_stored(const FrameRecord& record) {
    if (record.status == FrameStatus::kMapped) choose(record.submap, record.T_odom_lidar);
  }
  /// The range images since the last call.
  std::vector<KeyframeRecord> take() { return std::exchange(fresh_, {}); }

 private:
  /// Whether the next mapped frame is a keyframe.
  bool choose(int submap, const RigidMotion& T_odom_lidar);

  double spacing_;
  const DriveInfo& drive_;
  int submap_ = -1;  // of the last keyframe
  Eigen::Vector3d last_p_odom_ = Eigen::Vector3d::Zero();
  std::vector<KeyframeRecord> fresh_;
};

}  // namespace fovea
