// Registers what two maps have of one place.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/mapping/fusion/plan_view.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// Radius around the middle of a submap that is registered, m.
inline constexpr double kSubmapRadius = 50;

/// What map A has around a place, in the axes of its local frame.
struct PlaceTarget {
  /// @param points_a   m, relative to the place
  /// @param center_a   of the place, m, local frame of A
  PlaceTarget(std::vector<Eigen::Vector3f> points_a, const Eigen::Vector3d& center_a);

  RigidMotion T_a_place;
  PlanView plan;
  RegistrationCloud cloud;
  PointIndex index;
};

/// The points of map B in the space that both have, and how they lie in it.
struct CommonSpaceFit {
  RegistrationCloud source;
  RegistrationResult registration;
};

/// Whether B has enough points where A has some.
/// @param plan_a    of the points of A, relative to the place
/// @param points_b  m
bool has_common_space(const PlanView& plan_a, const std::vector<Eigen::Vector3f>& points_b,
                      const RigidMotion& guess_T_place_b);

/// Registers the common space; twice, since it shows once both lie right. Empty if it does not fit
/// within kPlaceReach of the guess.
std::optional<CommonSpaceFit> fit_common_space(const PlaceTarget& target,
                                               const std::vector<Eigen::Vector3f>& points_b,
                                               const RigidMotion& guess_T_target_b);

}  // namespace fovea
