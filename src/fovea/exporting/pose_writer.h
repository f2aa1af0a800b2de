// A map's poses as the text file that KITTI's odometry tools read.
#pragma once

#include <filesystem>
#include <vector>

#include "fovea/map/frame_record.h"

namespace fovea {

/// Writes T_local_lidar of every frame as a line: 12 numbers, 3x4 row-major, which read back to the
/// same doubles. Line n, from 0, is frame `frames.front().index + n`; an index without a frame has
/// a pose interpolated between its neighbors.
/// @param frames  by index; InputError if there is none
/// @param force   replace an existing file; else that is an OutputError
void write_kitti_poses(const std::vector<FrameRecord>& frames, const std::filesystem::path& path,
                       bool force);

}  // namespace fovea
