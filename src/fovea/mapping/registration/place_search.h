// Finds the pose of a scan in the local map from a guess with an error of several meters.
#pragma once

#include <optional>

#include "fovea/mapping/registration/local_map.h"

namespace fovea {

/// Fit of a scan to a place of the local map, 0 to 1: the share of its points with a counterpart,
/// times the share of VerticalFit. 0 if too few points are near vertical surfaces.
/// @param overlap  share of the scan's points with a counterpart
double place_score(const VerticalFit& fit, double overlap);

/// Correct places have a score of 0.6 to 1, wrong ones that resemble the scan up to 0.5.
inline constexpr double kLeastPlaceScore = 0.55;

struct FoundPlace {
  RegistrationResult registration;  ///< T_target_source is T_odom_lidar
  VerticalFit fit;
};

/// Registers a scan from several guesses: points of a cross around the given guess, with arms along
/// the axes of the LiDAR.
/// @param source_lidar  as for register_to()
/// @param reach         arm of the cross, m; at most 20 m are searched
/// @param options       of the final registration, which follows one with pairs of up to 4 m
/// @return the pose whose vertical surfaces fit best, or nothing if none confirms a pose
std::optional<FoundPlace> search_place(const LocalMap& map, const RegistrationCloud& source_lidar,
                                       const RigidMotion& guess_T_odom_lidar, double reach,
                                       const RegistrationOptions& options);

}  // namespace fovea
