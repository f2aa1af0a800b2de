// What the checks of all options share. Every function throws ConfigError that names the key.
#pragma once

#include <string_view>

namespace fovea {

[[noreturn]] void reject(std::string_view what, std::string_view key, std::string_view remedy);

/// ConfigError unless low <= value <= high; NaN is outside of everything.
void check_range(std::string_view key, double value, double low, double high,
                 std::string_view unit = "");

/// The same in degrees for a value in radians.
void check_degrees(std::string_view key, double radians, double low, double high);

}  // namespace fovea
