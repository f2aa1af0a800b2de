// Localised poses as files.
#pragma once

#include <ostream>
#include <vector>

#include "fovea/localization/localizer.h"

namespace fovea {

/// KITTI's form, a line a frame: T_local_lidar, 3x4 row-major; twelve times nan where the frame was
/// not localised.
void write_pose_lines(const std::vector<Localization>& frames, std::ostream& out);

/// CSV with a head: frame, time_ns, state, health, x, y, z (m), qx, qy, qz, qw, and the
/// covariance's upper triangle, row by row, of rx, ry, rz (rad), tx, ty, tz (m). Empty fields where
/// the frame was not localised.
void write_pose_table(const std::vector<Localization>& frames, std::ostream& out);

}  // namespace fovea
