#include "fovea/sweep_motion.h"

#include <algorithm>
#include <cmath>

#include "fovea/geometry/rotation_vector.h"

namespace fovea {

RigidMotion SweepPath::at(double dt) const {
  const double place = (dt - begin) / step;
  const double last = static_cast<double>(placements.size() - 2);
  const double whole = std::clamp(std::floor(place), 0.0, last);
  const Twist& from = placements[static_cast<std::size_t>(whole)];
  const Twist& to = placements[static_cast<std::size_t>(whole) + 1];
  const Twist placement = from + (place - whole) * (to - from);
  RigidMotion T = RigidMotion::Identity();
  T.linear() = rotation_of(placement.head<3>());
  T.translation() = placement.tail<3>();
  return T;
}

RigidMotion SweepMotion::T_later_moment(double dt) const {
  return path ? path->at(dt).inverse() : exp_se3(-over(dt));
}

}  // namespace fovea
