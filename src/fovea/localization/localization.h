// Where one scan was taken.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fovea/core/time.h"
#include "fovea/geometry/rigid_motion.h"

namespace fovea {

enum class LocalizationState {
  kLocalized,
  kLost,     ///< the scan fits nowhere that was tried
  kOutside,  ///< the map has next to nothing where the scan should have been taken
  kSkipped   ///< there was no scan
};
const char* to_string(LocalizationState state);

/// Of one scan. Poses are T_local_lidar at the scan's stamp, `local` the map's.
struct Localization {
  int index = 0;
  std::optional<TimeNs> stamp;
  LocalizationState state = LocalizationState::kSkipped;
  RigidMotion T_local_lidar = RigidMotion::Identity();  ///< where kLocalized
  /// Of a twist of the LiDAR in its own frame, rotation first (rad^2, m^2), where kLocalized.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of what the scan has standing where the map has something, the share that lies on a surface of
  /// the map, times the share of the map's that the scan does not see through: 0 to 1. Where not
  /// localized, of the best that was tried.
  double health = 0;
  /// Not from the pose before: the first of all, after it was lost, or elsewhere than predicted.
  bool found = false;
  int degenerate_directions = 0;  ///< of six, that the scene leaves open: predicted, not measured
};

}  // namespace fovea
