// Finds how far one map is shifted against another one from their walls, seen from above.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// Largest shift that is searched along each axis, m.
inline constexpr double kShiftReach = 25;

/// The horizontal shifts of B (m) that lay most of its walls on walls of A, best first, at least
/// 2 m apart, at most `most`. Empty without walls.
/// @param points_a, points_b  m, z up, around one place, with the same axes
std::vector<Eigen::Vector2d> likely_shifts(std::span<const Eigen::Vector3f> points_a,
                                           std::span<const Eigen::Vector3f> points_b,
                                           std::size_t most);

}  // namespace fovea
