#include "app/html_report/figure_table.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "app/html_report/figure_explanations.h"
#include "fovea/evaluation/report.h"

namespace fovea::app::figure_table_test {

using Json = nlohmann::ordered_json;

EvaluationReport full_report() {
  EvaluationReport report;
  report.figures.points = 12345;
  report.figures.te_mean = 10.123456789;
  report.without_moving = MovingReport{};
  report.by_rule[0] = {3, 0.5, 7};
  report.blocks = {{4, 9, {}}, {20, 25, {}}};
  report.color_rules = {{ColorRule::kFovea, 7, {}, 0.5}, {ColorRule::kFloor, {}, {}, {}}};
  return report;
}

/// Every number of the JSON by its place, but for the single frames and what describes the run.
void collect(const Json& json, const std::string& prefix, std::map<std::string, std::string>& all) {
  for (const auto& [name, value] : json.items()) {
    const std::string key = prefix.empty() ? name : prefix + "." + name;
    if (key == "frames" || key == "skipped" || key == "cameras" || key == "warnings" ||
        key == "images_missing") {
      continue;
    }
    const bool pair = value.is_array() && value.size() == 2 && !value[0].is_object();
    if (value.is_structured() && !pair) {
      collect(value, key, all);
    } else if (!value.is_string()) {
      all[key] = value.dump();
    }
  }
}

TEST(FigureTables, HoldEveryFigureOfTheJsonInFull) {
  const Json json = Json::parse(to_json(full_report()));
  std::map<std::string, std::string> expected, found;
  collect(json, "", expected);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(("<div>" + figure_tables(json) + "</div>").c_str()));
  for (const auto& row : document.select_nodes("//tr[@data-key]")) {
    found[row.node().attribute("data-key").value()] = row.node().attribute("data-value").value();
  }
  EXPECT_EQ(found, expected);
  EXPECT_GT(found.size(), 150u);
}

TEST(FigureTables, EveryFigureIsExplained) {
  const Json json = Json::parse(to_json(full_report()));
  std::map<std::string, std::string> all;
  collect(json, "", all);
  for (const auto& [key, value] : all) EXPECT_NE(explain_figure(key), "") << key;
}

TEST(FigureTables, ThePlaceDecidesWhereANameMeansTwoThings) {
  EXPECT_EQ(explain_figure("visible.te_mean"), explain_figure("te_mean"));
  EXPECT_NE(explain_figure("visible.intervals_95.te_mean"), explain_figure("te_mean"));
  EXPECT_EQ(explain_figure("no_such_figure"), "");
}

}  // namespace fovea::app::figure_table_test
