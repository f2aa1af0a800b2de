// Scan-matching error: how well neighbouring scans lie on each other (paper: first chart of the
// results).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/evaluation/scored_map.h"

namespace fovea {

struct ScanMatching {
  /// m, over all matched points of all pairs of frames; NaN if there is none
  double mean = std::numeric_limits<double>::quiet_NaN();
  std::size_t points = 0;  ///< matched
  std::size_t pairs = 0;   ///< of neighbouring frames
};

/// The points of a scan that are matched: original ones without ground, in view of any of the
/// cameras.
/// @param scan_lidar  the whole scan, motion compensated
std::vector<Eigen::Vector3f> matched_points(const PointCloud& scan_lidar,
                                            const std::vector<Camera>& cameras);

/// Two scans' matched points, each in its LiDAR's frame, the source placed in the target's.
ScanMatching match_scans(const std::vector<Eigen::Vector3f>& source,
                         const std::vector<Eigen::Vector3f>& target,
                         const RigidMotion& T_target_source);

/// Mean distance from the points of each mapped scan, placed by the map's poses, to the nearest
/// point of the mapped scan before it: ORIGINAL points only (with interpolated ones the figure
/// falls by density alone), without ground, in view of one of the drive's cameras, pairs under 1 m
/// (docs/method.md 2). Scans are motion compensated with the map's velocities. Does not depend on
/// the number of threads.
ScanMatching scan_matching(const ScoredMap& map, const FrameSource& drive);

}  // namespace fovea
