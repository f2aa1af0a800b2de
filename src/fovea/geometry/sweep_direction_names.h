// Directions of rotation as settings name them.
#pragma once

#include <array>

#include "fovea/core/settings.h"
#include "fovea/geometry/sensor_profile.h"

namespace fovea {

constexpr auto names_of(SweepDirection) {
  return std::array{
      EnumName<SweepDirection>{SweepDirection::kClockwise, "clockwise"},
      EnumName<SweepDirection>{SweepDirection::kCounterclockwise, "counterclockwise"}};
}

}  // namespace fovea
