// Messages that a recording should have.
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/time.h"

namespace fovea {

/// How many messages are missing in the gaps between stamps of a sensor with a steady rate: 0 if
/// the rate is not steady.
/// @param stamps  ascending
std::size_t missing_messages(const std::vector<TimeNs>& stamps);

}  // namespace fovea
