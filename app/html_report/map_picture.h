// The map as a whole.
#pragma once

#include <string>

#include "fovea/evaluation/scorer.h"

namespace fovea::app {

/// The map from behind and above the vehicle at the middle of the drive, as an <img>.
std::string hero_picture(const ScoredMap& map, const Scorer& scorer);

}  // namespace fovea::app
