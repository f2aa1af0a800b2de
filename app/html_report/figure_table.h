// Every figure of an evaluation with what it means.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace fovea::app {

/// Figures that stand in a table of their own.
struct FigureGroup {
  /// An object or list in the JSON; what begins so, where it ends with "_"; "" for what of the top
  /// no other group has.
  std::string key;
  std::string title, text;
};

/// Tables of the figures of a report's JSON, a group each, but for the single frames; each row
/// carries its place in the JSON (data-key, "bleeding.te_edges") and its value in full
/// (data-value). Groups of which the report has nothing are left out.
/// @param explain  what the figure at a place of the JSON means, plain text
std::string figure_tables(const nlohmann::ordered_json& report,
                          const std::vector<FigureGroup>& groups,
                          const std::function<std::string(const std::string& key)>& explain);

/// Those of an evaluation. @param report  see to_json(EvaluationReport)
std::string figure_tables(const nlohmann::ordered_json& report);

/// A table of the views, a row each.
std::string view_table(const nlohmann::ordered_json& report);

}  // namespace fovea::app
