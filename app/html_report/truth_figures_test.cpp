#include "app/html_report/truth_figures.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "fovea/evaluation/truth_report.h"

namespace fovea::app::truth_figures_test {

using Json = nlohmann::ordered_json;

Json full_report() {
  TruthReport report;
  report.ghosts = 12;
  report.map_points_coloured = 100;
  report.accuracy.mean = 0.00123456789;
  report.frames = {{4, 0.01, 0.1, 7, 1}, {5, 0.02, 0.1, {}, {}}};
  return Json::parse(to_json(report));
}

/// Every figure of the JSON by its place, but for the single frames and what describes the run.
std::map<std::string, std::string> figures(const Json& json) {
  std::map<std::string, std::string> all;
  for (const auto& [name, value] : json.items()) {
    const bool is_figure = name != "frames" && name != "cameras" && name != "warnings";
    if (!is_figure || value.is_string()) continue;
    if (!value.is_object()) {
      all[name] = value.dump();
      continue;
    }
    for (const auto& [inner, figure] : value.items()) all[name + "." + inner] = figure.dump();
  }
  return all;
}

TEST(TruthFigureTables, HoldEveryFigureOfTheJsonInFullAndExplainIt) {
  const Json json = full_report();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(("<div>" + truth_figure_tables(json) + "</div>").c_str()));
  std::map<std::string, std::string> found;
  for (const auto& row : document.select_nodes("//tr[@data-key]")) {
    found[row.node().attribute("data-key").value()] = row.node().attribute("data-value").value();
    EXPECT_STRNE(row.node().last_child().text().get(), "")
        << row.node().attribute("data-key").value();
  }
  EXPECT_EQ(found, figures(json));
  EXPECT_GT(found.size(), 90u);
}

TEST(TruthFigureTables, ThePlaceDecidesWhatAFigureMeans) {
  EXPECT_NE(explain_truth_figure("pose_aligned_m"), explain_truth_figure("pose_absolute_m"));
  EXPECT_EQ(explain_truth_figure("completeness_2cm"), explain_truth_figure("completeness_20cm"));
  EXPECT_NE(explain_truth_figure("worst_frame.points"), explain_truth_figure("color_view.points"));
  EXPECT_EQ(explain_truth_figure("no_such_figure"), "");
}

TEST(TruthFrameTable, HasARowAFrame) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(truth_frame_table(full_report()).c_str()));
  const auto rows = document.select_nodes("//tbody/tr");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_STREQ(rows[0].node().first_child().text().get(), "4");
  EXPECT_STREQ(rows[1].node().last_child().text().get(), "none");  // points name no frame
}

}  // namespace fovea::app::truth_figures_test
