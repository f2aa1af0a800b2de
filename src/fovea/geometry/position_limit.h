// How far from the origin of its frame a position can be.
#pragma once

#include <Eigen/Core>

#include "fovea/platform.h"

namespace fovea {

/// m, along each axis. Local frames of any map projection lie within. A position beyond is damaged.
inline constexpr double kMaxPosition = 1e7;

/// False for NaN, too.
inline bool is_possible_position(const Eigen::Vector3d& position) {
  return (position.array().abs() <= kMaxPosition).all();
}

}  // namespace fovea
