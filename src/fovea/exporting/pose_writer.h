// A map's poses as the text file that KITTI's odometry tools read.
#pragma once

#include <filesystem>
#include <vector>

#include "fovea/map/frame_record.h"

namespace fovea {

/// Writes T_local_lidar of every frame as a line: 12 numbers, 3x4 row-major, which read back to the
/// same doubles. Line n, from 0, is frame `frames.front().index + n`.
/// @param frames  by index, without gaps; InputError if there is none or one is missing
/// @param force   replace an existing file; else that is an OutputError
void write_kitti_poses(const std::vector<FrameRecord>& frames, const std::filesystem::path& path,
                       bool force);

}  // namespace fovea
