// Map points that stem from something that moved: they stand where nothing is.
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/evaluation/truth_poses.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Marks (1) the points whose nearest true return, among those of the frame that the point came
/// from, lies within 0.5 m and on a moving thing. Points are compared under the map's own pose of
/// that frame, so that no pose error makes or hides a ghost.
/// @param points_map  the map's local frame, column frame; points of frames not in `frames` are
///                    none
std::vector<std::uint8_t> find_ghosts(const PointCloud& points_map,
                                      const std::vector<PosePair>& frames, const DriveTruth& truth);

}  // namespace fovea
