// Every figure of an evaluation with what it means.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace fovea::app {

/// Tables of all figures of an evaluation's JSON, a group each, but for the single frames; each row
/// carries its place in the JSON (data-key, "bleeding.te_edges") and its value in full
/// (data-value).
/// @param report  see to_json(EvaluationReport)
std::string figure_tables(const nlohmann::ordered_json& report);

/// A table of the views, a row each.
std::string view_table(const nlohmann::ordered_json& report);

/// What the figure of this name means, in one line (docs/method.md 7); empty if it is not known.
std::string explain_figure(const std::string& key);

}  // namespace fovea::app
