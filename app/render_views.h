// The places of a free camera on the command line.
#pragma once

#include <string>

#include "fovea/evaluation/map_picture.h"

namespace fovea::app {

/// CLI::ValidationError if one is none, or both are the same.
/// @param from, to  "X,Y,Z" in the local frame, m
FreeView parse_free_view(const std::string& from, const std::string& to);

}  // namespace fovea::app
