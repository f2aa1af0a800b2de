// How wrong GPS and INS are.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// What a record says too much.
struct NavigationError {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, east, north, up
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();    ///< rad, roll, pitch, yaw
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, east, north, up
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();      ///< rad/s, around the unit's axes
  bool outage = false;                                 ///< no satellite is seen
  double accuracy =
      0;  ///< m, standard deviation of a horizontal coordinate, as the unit estimates it
};

/// Errors of records at these times (s from frame 0's stamp, increasing):
/// a constant bias; random walks of position and angles; white noise; jumps of the position, which
/// stay (GPS found another solution); and, where asked for, outages: in every 20 s one of 4 to 10 s
/// that begins after 2 to 6 s, during which the position drifts ten times as fast, and the velocity
/// by five times its noise in a second, and after which that drift is gone, as satellites are back.
/// Those of the first n records do not depend on the
/// rest.
std::vector<NavigationError> navigation_errors(const std::vector<double>& times,
                                               const NavigationOptions& options, int seed);

}  // namespace fovea
