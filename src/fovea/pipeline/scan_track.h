// The motion of the LiDAR over a drive, without a map.
#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/mapping/calibration/hand_eye_search.h"
#include "fovea/pipeline/incremental_mapper.h"
#include "fovea/pipeline/map_settings.h"

namespace fovea {

struct TrackedPose {
  int frame = 0;
  TimeNs stamp = 0;
  RigidMotion T_odom_lidar = RigidMotion::Identity();  ///< without corrections by loops
  SweepMotion motion;                                  ///< about the stamp
  bool is_firm = true;  ///< registration has determined all six directions, or the pose is given
};

struct ScanTrackJob {
  MapSettings settings;
  PoseSource pose_source = PoseSource::kRefine;
  std::vector<RigidMotion> given_poses;  ///< as MapJob::given_poses
  std::stop_token stop;                  ///< ends with the frames at hand
  std::function<void(int done, int total)> progress = [](int, int) {};
};

/// Tracks the frames of a drive. Frames without a pose are left out.
std::vector<TrackedPose> track_scans(const FrameSource& source, const ScanTrackJob& job);

/// Rotations from each pose to the next. Leaves out those to a pose that is not firm, and those of
/// over half a second.
std::vector<ScanTurn> turns_of(const std::vector<TrackedPose>& poses);

}  // namespace fovea
