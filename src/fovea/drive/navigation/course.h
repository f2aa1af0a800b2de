// Headings of a vehicle of which only positions are known.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/platform.h"
#include "fovea/time.h"

namespace fovea {

/// Heading at each place (rad, 0 = along x, counter-clockwise): the direction of the way through
/// it, between the nearest places before and after that are a meter apart; where the vehicle stands
/// (no meter within two seconds), that of before, or else of afterwards. Empty if it never moves,
/// and no heading is given.
/// @param times      strictly increasing, one a place
/// @param positions  m; z does not matter
/// @param before     heading before the first place, if it is known
std::optional<std::vector<double>> course_headings(const std::vector<TimeNs>& times,
                                                   const std::vector<Eigen::Vector3d>& positions,
                                                   std::optional<double> before = std::nullopt);

}  // namespace fovea
