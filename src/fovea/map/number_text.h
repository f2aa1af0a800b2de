// Numbers as text that reads back to the same double, whatever the locale.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/sweep_motion.h"

namespace fovea {

/// Shortest such text of each number, with a space between two.
std::string to_text(std::span<const double> numbers);
/// The numbers of a text, or nothing if anything in it is not a finite number.
std::optional<std::vector<double>> numbers_from_text(std::string_view text);

/// What format_pose() wrote; nothing unless the text is 12 finite numbers.
std::optional<RigidMotion> motion_from_text(std::string_view text);

/// The velocity, and the acceleration where there is one.
std::string to_text(const SweepMotion& motion);
/// Nothing unless the text is 6 or 12 finite numbers.
std::optional<SweepMotion> sweep_motion_from_text(std::string_view text);

/// A JSON object in the order of the names; a number that is not finite becomes null.
std::string to_json(const std::map<std::string, double>& numbers);
/// Nothing unless the text is a JSON object of numbers and nulls, which become NaN.
std::optional<std::map<std::string, double>> numbers_from_json(std::string_view text);

}  // namespace fovea
