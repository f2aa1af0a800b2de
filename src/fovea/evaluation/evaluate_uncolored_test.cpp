#include "fovea/evaluation/evaluate_uncolored.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/errors.h"
#include "fovea/evaluation/test_scene.h"

namespace fovea::evaluate_uncolored_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

ScoredMap uncolored_wall(double spacing, float shift = 0) {
  PointCloud points = WallScene::map(spacing);
  points.camera.assign(points.size(), kNoCamera);
  for (Eigen::Vector3f& p : points.position) p.x() += shift;
  ScoredMap map = wall_map(std::move(points));
  map.cameras.clear();
  return map;
}

TEST(EvaluateUncolored, PositionsAreScoredAndColorsAreAbsent) {
  const WallDrive drive(9, {});
  const EvaluationReport report = evaluate(uncolored_wall(0.01), drive, {});
  EXPECT_FALSE(report.colored);
  EXPECT_TRUE(report.cameras.empty());
  EXPECT_EQ(report.frames, 1u);
  EXPECT_GT(report.figures.points, 10'000u);
  // On average 0.38 spacings from the nearest point of a square grid; the scan goes past its edges.
  EXPECT_GT(report.figures.me_mean, 0.0038);
  EXPECT_LT(report.figures.me_mean, 0.005);
  EXPECT_GT(report.figures.coverage_5cm, 0.99);
  EXPECT_EQ(report.free_space.share(), 0);
  EXPECT_GT(report.free_space.tested, 100'000u);
  EXPECT_NEAR(report.density_per_m2, 10'000, 300);
  EXPECT_LT(report.thickness.thickness, 1e-4);
  EXPECT_TRUE(std::isnan(report.figures.te_mean));
  EXPECT_TRUE(report.warnings.empty());
}

TEST(EvaluateUncolored, AMapBesideTheWallHasThatError) {
  const EvaluationReport report = evaluate(uncolored_wall(0.01, 0.1f), WallDrive(9, {}), {});
  EXPECT_NEAR(report.figures.me_mean, 0.1, 2e-3);
  EXPECT_EQ(report.figures.coverage_5cm, 0);
  EXPECT_GT(report.figures.coverage_20cm, 0.99);
}

TEST(EvaluateUncolored, ReportsSayThatColorsAreAbsent) {
  const EvaluationReport report = evaluate(uncolored_wall(0.02), WallDrive(), {});
  EXPECT_THAT(to_text(report), AllOf(HasSubstr("the map has no colors"), HasSubstr("ME mean"),
                                     HasSubstr("coverage 5 cm"), Not(HasSubstr("TE mean"))));
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json.at("colored"), false);
  EXPECT_TRUE(json.at("te_mean").is_null());
  EXPECT_TRUE(json.at("mtme").is_null());
  EXPECT_GT(json.at("me_mean"), 0);
}

TEST(EvaluateUncolored, WhatNeedsColorsIsRefused) {
  const WallDrive drive;
  ProtocolOptions options;
  options.protocol = Protocol::kCrossCamera;
  EXPECT_THROW(evaluate(uncolored_wall(0.02), drive, options), InputError);
  ScoredMap empty = uncolored_wall(0.02);
  empty.points_local = {};
  EXPECT_THROW(evaluate(empty, drive, {}), InputError);
}

}  // namespace fovea::evaluate_uncolored_test
