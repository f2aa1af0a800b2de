// The result of comparing colour rules, and its two forms: JSON for programs, a table for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fovea/evaluation/color_rules.h"
#include "fovea/evaluation/metrics.h"

namespace fovea {

struct ColorRuleScore {
  ColorRule rule = ColorRule::kFovea;
  /// Map points that the rule gave a colour; absent for the floor, which colours held-out points.
  std::optional<std::size_t> points_coloured;
  /// Of the held-out points whose nearest map point EVERY rule coloured: the same for all rules.
  ErrorFigures figures;
  /// Of the points that every rule coloured, drawn; absent for the floor.
  std::optional<double> sharpness;
};

/// A list of objects, one a rule; figures that do not exist are null.
nlohmann::ordered_json to_json(const std::vector<ColorRuleScore>& scores);

/// A table for the terminal, lines ending with LF; nothing for no scores.
std::string to_text(const std::vector<ColorRuleScore>& scores);

}  // namespace fovea
