// Every figure of a comparison with the truth, with what it means.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace fovea::app {

/// Tables as figure_tables() makes them. @param report  see to_json(TruthReport)
std::string truth_figure_tables(const nlohmann::ordered_json& report);

/// What the figure at this place of the JSON means, in one line (docs/simulator.md); empty if it is
/// not known.
std::string explain_truth_figure(const std::string& key);

/// A table of the frames, a row each.
std::string truth_frame_table(const nlohmann::ordered_json& report);

}  // namespace fovea::app
