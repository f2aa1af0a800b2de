// A sensor profile as JSON that reads back bit for bit (docs/map-format.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "fovea/geometry/sensor_profile.h"

namespace fovea {

/// All but the profile's name. std::invalid_argument if a number is not finite.
std::string to_json(const SensorProfile& profile);
/// The profile without a name. Nothing unless the text is a JSON object with all keys that
/// to_json() writes. Other keys are skipped if their values are numbers, texts or lists of numbers.
std::optional<SensorProfile> sensor_profile_from_json(std::string_view text);

}  // namespace fovea
