// Errors of a map's poses against the true ones (docs/simulator.md).
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/drive_truth.h"
#include "fovea/evaluation/distribution.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// The LiDAR's pose at one frame's stamp, by the truth and by the map. `true` is the truth's local
/// frame, `map` the map's.
struct PosePair {
  int frame = 0;
  RigidMotion T_true_lidar = RigidMotion::Identity();
  RigidMotion T_map_lidar = RigidMotion::Identity();
};

/// One for each frame of the map that was not skipped and that the truth knows, by frame.
/// InputError if there is none.
std::vector<PosePair> pose_pairs(const std::vector<FrameRecord>& frames, const DriveTruth& truth);

/// T_true_map of a georeferenced map, from the two origins; nothing for other maps and clouds.
std::optional<RigidMotion> georeference(const MapMeta& meta, const GeodeticPoint& truth_origin);

/// T_true_map that lays the trajectories over each other: the mean of the frames' rotations
/// (chordal) and the translation that then minimises the squared distances of the LiDARs.
RigidMotion align_trajectories(const std::vector<PosePair>& pairs);

/// T_true_map that lays many drives over their truths: least squares of the positions of the LiDARs
/// and of points 1 m from them along their axes. Rotations of single frames count little, as those
/// of a city do.
RigidMotion align_drives(const std::vector<PosePair>& pairs);

/// What a pose in the map is off beside the map's own pose nearest to it, in its own frame: errors
/// that the map has from end to end are not counted.
/// @param map  at least one
RigidMotion error_beside(const std::vector<PosePair>& map, const PosePair& pose);

struct PoseErrors {
  std::vector<float> position_m, rotation_deg;  ///< an entry a frame, or a pair of frames
};

/// Of each frame.
PoseErrors absolute_errors(const std::vector<PosePair>& pairs, const RigidMotion& T_true_map);

/// Of the motion between each two frames whose numbers follow each other.
PoseErrors relative_errors(const std::vector<PosePair>& pairs);

/// Of the motion over each piece of at least `length` m of the true way (from every frame to the
/// first that is so far on): the position error in % of the piece's length. Empty for a shorter
/// drive.
std::vector<float> drift_percent(const std::vector<PosePair>& pairs, double length);

}  // namespace fovea
