// A map's frames as a table: stamps, poses and gains.
#pragma once

#include <filesystem>
#include <vector>

#include "fovea/map/frame_record.h"

namespace fovea {

/// Writes CSV: a line with the names of the columns, then one line for each frame. The columns are
/// index, time_ns, status, the 12 numbers of T_local_lidar (3x4, row by row), and for each camera K
/// of the map gain_K_r, gain_K_g and gain_K_b: image = map * gain. What the map does not state is
/// empty. Numbers read back to the same doubles.
/// @param frames  by index; InputError if there is none
/// @param force   replace an existing file; else that is an OutputError
void write_frame_table(const std::vector<FrameRecord>& frames, const std::filesystem::path& path,
                       bool force);

}  // namespace fovea
