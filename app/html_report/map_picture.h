// The map as a whole.
#pragma once

#include <string>

#include "fovea/evaluation/scorer.h"

namespace fovea::app {

/// The map from behind and above the vehicle at the middle of the drive, as an <img>.
std::string hero_picture(const ScoredMap& map, const Scorer& scorer);

/// Points from behind and above the vehicle at a pose, as an <img>.
/// @param spacing  of the points, see sample_spacing
/// @param T_local_lidar  in the points' frame
/// @param alt  what the picture shows, plain text
std::string picture_from_behind(const ColoredPoints& points, const std::vector<float>& spacing,
                                const RigidMotion& T_local_lidar, const std::string& alt,
                                const ColorDisplay& display = {});

}  // namespace fovea::app
