#include "fovea/evaluation/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fovea::report_test {

using testing::HasSubstr;

EvaluationReport some_report() {
  EvaluationReport report;
  report.cameras = {2, 3};
  report.figures = summarize({{0.1f, 0.3f}, {10, 30}, {5, 7}});
  report.paper_like = summarize({{0.0f, 0.2f}, {100, 200}, {50, 60}});
  report.free_space = {8, 2, 1};
  report.gradients = {100, 3, 4};
  report.density_per_m2 = 1234.5;
  report.map_points = 20;
  report.map_points_coloured = 15;
  report.frames = 1;
  report.views.push_back({4, 2, report.figures, {1, 2, 3}, {10, 1, 2}});
  report.skipped.push_back({12, "missing scan"});
  return report;
}

TEST(Report, HasTheKeysOfTheContract) {
  const nlohmann::json json = nlohmann::json::parse(to_json(some_report()));
  EXPECT_EQ(json["protocol"], "held-out");
  EXPECT_EQ(json["cameras"], (std::vector<int>{2, 3}));
  EXPECT_EQ(json["points"], 2);
  for (const auto& [key, value] :
       std::map<std::string, double>{{"me_mean", 0.2},
                                     {"me_std", 0.1},
                                     {"te_mean", 20},
                                     {"te_std", 10},
                                     {"te_median", 20},
                                     {"te_within_20", 0.5},
                                     {"te_gain_mean", 6},
                                     {"te_gain_within_20", 1},
                                     {"free_space_violations", 0.25},
                                     {"free_space_violations_enclosed", 0.125},
                                     {"sharpness", 0.75},
                                     {"mtme", 5},
                                     {"coverage_5cm", 0},
                                     {"coverage_20cm", 0.5},
                                     {"density_per_m2", 1234.5},
                                     {"te_percent", 2000 / 255.0}}) {
    ASSERT_TRUE(json.contains(key)) << key;
    EXPECT_NEAR(json[key].get<double>(), value, 1e-6) << key;
  }
  EXPECT_NEAR(json["paper_like"]["te_mean"].get<double>(), 150, 1e-6);
  EXPECT_EQ(json["frames"][0]["frame"], 4);
  EXPECT_EQ(json["frames"][0]["sharpness"], 0.5);
  EXPECT_EQ(json["frames"][0]["gain"], (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(json["skipped"][0]["reason"], "missing scan");
}

TEST(Report, HasTheFiguresBesideTheContracts) {
  EvaluationReport report = some_report();
  report.figures =
      summarize({{0.1f, 0.3f}, {10, 30}, {5, 7}, {1, 4}, std::vector<std::uint8_t>{1, 0}});
  report.intervals.te = {12, 28};
  report.map_share_interpolated = 0.75;
  report.by_rule[reason_of(PointRule::kPlanar)] = {4, 0.2, 80};
  const nlohmann::json json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["te_ciede2000_mean"], 2.5);
  EXPECT_EQ(json["te_ciede2000_median"], 2.5);
  EXPECT_EQ(json["share_interpolated"], 0.5);
  EXPECT_EQ(json["map_share_interpolated"], 0.75);
  EXPECT_EQ(json["intervals_95"]["te_mean"], (std::vector<double>{12, 28}));
  EXPECT_EQ(json["by_rule"],
            (nlohmann::json{{"planar", {{"points", 4}, {"me_mean", 0.05}, {"te_mean", 20.0}}}}));
  EXPECT_NE(to_text(report).find("nearest is planar"), std::string::npos);
  EXPECT_TRUE(json["intervals_95"]["me_mean"][0].is_null());
}

TEST(Report, WarningsAreInTheJson) {
  EvaluationReport report = some_report();
  report.warnings = {"too good to be true"};
  EXPECT_EQ(nlohmann::json::parse(to_json(report))["warnings"],
            std::vector<std::string>{"too good to be true"});
  for (const char* key : {"bleeding", "consistency", "geometry", "pictures"}) {
    EXPECT_TRUE(nlohmann::json::parse(to_json(report))[key].is_object()) << key;
  }
}

TEST(Report, NamesTheWorstFrame) {
  EvaluationReport report = some_report();
  ViewReport bad = report.views[0];
  bad.frame = 20;
  bad.figures.te_mean = 99;
  report.views.push_back(bad);
  report.views.push_back({28, 2, {}, {1, 1, 1}, {}});  // without a point
  EXPECT_EQ(nlohmann::json::parse(to_json(report))["worst_frame"]["frame"], 20);
  EXPECT_THAT(to_text(report), testing::ContainsRegex("worst frame +20  camera 2: .*TE 99.00"));
}

TEST(Report, WhatDoesNotExistIsNull) {
  EvaluationReport report;
  const nlohmann::json json = nlohmann::json::parse(to_json(report));
  for (const char* key : {"me_mean", "sharpness", "free_space_violations"}) {
    EXPECT_TRUE(json.at(key).is_null()) << key;
  }
  EXPECT_EQ(json["points"], 0);
  EXPECT_TRUE(json["frames"].is_array());
}

TEST(Report, InSampleFiguresAreExplained) {
  EvaluationReport report = some_report();
  report.protocol = Protocol::kInSample;
  const std::string held_out_matters = "held-out figures do";
  EXPECT_THAT(to_json(report), HasSubstr(held_out_matters));
  EXPECT_THAT(to_text(report), HasSubstr(held_out_matters));
}

TEST(Report, TextHasEveryFigure) {
  const std::string text = to_text(some_report());
  for (const char* part : {"held-out, camera 2, 3: 2 points of 1 frames (1 skipped)", "0.2000",
                           "20.00", "0.750", "0.2500", "1234", "150.00", "15 coloured of 20"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

}  // namespace fovea::report_test
