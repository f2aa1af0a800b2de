// Pose files in KITTI's odometry form: one 3x4 matrix a line, 12 numbers, row-major.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/rigid_motion.h"

namespace fovea {

/// The pose with this 3x4 matrix, which a file or another program gives. A rotation of few digits
/// becomes the nearest one; full digits stay as they are. std::invalid_argument if a number is not
/// finite, a position is impossible (kMaxPosition), or there is no rotation.
RigidMotion checked_pose(const Eigen::Matrix<double, 3, 4>& matrix);

/// The poses of a file, in order. InputError naming file and line if the file cannot be read or is
/// empty, and for a line that has not 12 finite numbers or no rotation.
std::vector<RigidMotion> read_poses(const std::filesystem::path& file);

/// The poses of frames [begin, end): of a file with a line for each of them, or of one with a line
/// for every frame from 0 on. With fewer lines those of the first frames, if the range begins at
/// frame 0; InputError if it does not: nobody knows whose they are.
std::vector<RigidMotion> read_poses(const std::filesystem::path& file, int begin, int end);

/// The same of a file in which lines of twelve times "nan" stand for poses that nobody knows, as
/// `fovea localize` writes them.
std::vector<std::optional<RigidMotion>> read_poses_with_gaps(const std::filesystem::path& file);
std::vector<std::optional<RigidMotion>> read_poses_with_gaps(const std::filesystem::path& file,
                                                             int begin, int end);

/// Twelve times "nan".
std::string pose_gap();

/// "r00 r01 r02 tx r10 ... tz", the shortest text that reads back to the same doubles.
std::string format_pose(const RigidMotion& pose);

}  // namespace fovea
