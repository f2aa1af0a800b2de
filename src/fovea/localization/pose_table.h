// Localised poses as files.
#pragma once

#include <ostream>
#include <vector>

#include "fovea/localization/localizer.h"

namespace fovea {

/// KITTI's form, a line for each frame of [begin, end): T_local_lidar, 3x4 row-major; pose_gap()
/// for one that was not localized or not asked for.
/// @param frames  by index
void write_pose_lines(const std::vector<Localization>& frames, int begin, int end,
                      std::ostream& out);

/// CSV with a head: frame, time_ns, state, health, x, y, z (m), qx, qy, qz, qw, and the
/// covariance's upper triangle, row by row, of rx, ry, rz (rad), tx, ty, tz (m). Empty fields where
/// the frame was not localized.
void write_pose_table(const std::vector<Localization>& frames, std::ostream& out);

}  // namespace fovea
