#include "fovea/evaluation/evaluate_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/evaluation/truth_test_scene.h"
#include "fovea/geometry/transform_cloud.h"

namespace fovea::evaluate_truth_test {

class EvaluateTruth : public testing::Test {
 protected:
  static void SetUpTestSuite() { scene_ = new TruthScene; }
  static void TearDownTestSuite() { delete scene_; }

  static TruthReport evaluate(const ScoredMap& map, const TruthOptions& options = {}) {
    return evaluate_truth(map, scene_->drive(), options);
  }
  static TruthReport evaluate(PointCloud points) {
    return evaluate(scene_->map(std::move(points)));
  }

  static PointCloud moved(PointCloud points, const Eigen::Vector3f& shift) {
    for (Eigen::Vector3f& p : points.position) p += shift;
    return points;
  }

  static TruthScene* scene_;
};
TruthScene* EvaluateTruth::scene_ = nullptr;

TEST_F(EvaluateTruth, APerfectMapHasNoError) {
  const TruthReport report = evaluate(WallScene::map(0.02));
  EXPECT_EQ(report.scene, "street");
  EXPECT_EQ(report.frames.size(), 9u);
  EXPECT_LT(report.pose_aligned.position_m.max, 1e-9);
  EXPECT_LT(report.pose_absolute.rotation_deg.max, 1e-5);
  EXPECT_EQ(report.accuracy.count, report.map_points);
  EXPECT_LT(report.accuracy.max, 1e-6);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(report.shares.precision[k], 1);
  EXPECT_GT(report.shares.completeness[0], 0.99);  // the map has a point every 2 cm
  EXPECT_EQ(report.shares.completeness[1], 1);
  EXPECT_GT(report.shares.seen, 1000u);
  EXPECT_LT(report.color_view.raw.mean, 2);
  EXPECT_EQ(report.color_view.within_20, 1);
  EXPECT_GT(report.color_view.raw.count, 50'000u);
  EXPECT_EQ(report.ghosts, 0u);
}

TEST_F(EvaluateTruth, AnOffsetIsTheAccuracy) {
  PointCloud points = moved(WallScene::map(0.02), {0.01f, 0, 0});
  const PointCloud deeper = moved(WallScene::map(0.02), {-0.03f, 0, 0});
  points.append(deeper);
  points.interpolated.assign(points.size(), 0);
  std::fill(points.interpolated.begin() + std::ptrdiff_t(deeper.size()), points.interpolated.end(),
            std::uint8_t{1});
  const TruthReport report = evaluate(points);
  EXPECT_NEAR(report.accuracy_measured.mean, 0.01, 1e-6);
  EXPECT_NEAR(report.accuracy_measured.p95, 0.01, 1e-6);
  EXPECT_NEAR(report.accuracy_interpolated.median, 0.03, 1e-6);
  EXPECT_NEAR(report.accuracy.mean, 0.02, 1e-6);
  EXPECT_NEAR(report.accuracy.max, 0.03, 1e-6);
  EXPECT_EQ(report.shares.precision[0], 0.5);
  EXPECT_EQ(report.shares.precision[1], 1);
}

TEST_F(EvaluateTruth, AMapSomewhereElseIsAlignedByItsPoses) {
  RigidMotion T_map_true = RigidMotion::Identity();
  T_map_true.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, -2, 3).normalized()).matrix();
  T_map_true.translation() = Eigen::Vector3d(3000, 200, -10);
  ScoredMap map = scene_->map(WallScene::map(0.02));
  map.points_local = transform_cloud(map.points_local, T_map_true, T_map_true.translation());
  for (FrameRecord& record : map.frames) record.T_local_lidar = T_map_true * record.T_local_lidar;
  const TruthReport report = evaluate(map);
  EXPECT_GT(report.pose_absolute.position_m.mean, 3000);
  EXPECT_NEAR(report.pose_absolute.rotation_deg.mean, 0.5 * 180 / std::numbers::pi, 1e-4);
  EXPECT_LT(report.pose_aligned.position_m.max, 1e-6);
  EXPECT_LT(report.accuracy.max, 1e-5);
  EXPECT_LT(report.color_view.raw.mean, 2);
  EXPECT_EQ(report.shares.completeness[1], 1);
}

TEST_F(EvaluateTruth, WithoutAlignmentTheMapStaysWhereItLies) {
  ScoredMap map = scene_->map(moved(WallScene::map(0.02), {0.04f, 0, 0}));
  for (FrameRecord& record : map.frames) record.T_local_lidar.translation().x() += 0.04;
  EXPECT_LT(evaluate(map).accuracy.max, 1e-5);
  const TruthReport report = evaluate(map, {.align = false});
  EXPECT_FALSE(report.aligned);
  EXPECT_FALSE(report.georeferenced);
  EXPECT_NEAR(report.accuracy.mean, 0.04, 1e-5);
  EXPECT_NEAR(report.frames[3].position_m, 0.04, 1e-6);

  const GeodeticPoint origin = LocalTangentPlane(TruthScene::origin()).to_geodetic({-0.04, 0, 0});
  map.meta = {{"origin.latitude_deg", fmt::format("{}", origin.latitude)},
              {"origin.longitude_deg", fmt::format("{}", origin.longitude)},
              {"origin.height_m", fmt::format("{}", origin.altitude)}};
  const TruthReport on_earth = evaluate(map, {.align = false});
  EXPECT_TRUE(on_earth.georeferenced);
  EXPECT_LT(on_earth.accuracy.mean, 1e-5);
  EXPECT_LT(on_earth.pose_absolute.position_m.max, 1e-5);
}

TEST_F(EvaluateTruth, AHoleLowersCompletenessOnly) {
  const PointCloud whole = WallScene::map(0.02);
  std::vector<std::uint32_t> left;
  for (std::uint32_t i = 0; i < whole.size(); ++i) {
    if (whole.position[i].y() < 0) left.push_back(i);
  }
  const TruthReport report = evaluate(whole.select(left));
  EXPECT_EQ(report.shares.precision[0], 1);
  EXPECT_NEAR(report.shares.completeness[1], 0.5, 0.01);
  EXPECT_NEAR(report.shares.completeness[3], 0.52, 0.015);  // 20 cm of 5 m more
  EXPECT_NEAR(report.shares.f_score[1], 2 / 3.0, 0.01);
}

TEST_F(EvaluateTruth, ColorsAreComparedWithWhatThePerfectCameraSaw) {
  PointCloud shifted = WallScene::map(0.02);
  for (LogColor& c : shifted.color) c = to_rgb(to_float(c) + Eigen::Vector3f(0, 30, 0));
  const TruthReport green = evaluate(shifted);
  EXPECT_NEAR(green.color_view.raw.mean, 30, 1);
  EXPECT_EQ(green.color_view.within_20, 0);
  EXPECT_GT(green.color_view.gain.mean, 5);  // an offset is no gain

  PointCloud dark = WallScene::map(0.02);
  for (LogColor& c : dark.color)
    c = to_rgb(to_float(c).cwiseProduct(Eigen::Vector3f(0.5f, 0.8f, 0.6f)));
  const TruthReport report = evaluate(dark);
  EXPECT_GT(report.color_view.raw.mean, 60);
  EXPECT_LT(report.color_view.gain.mean, 3);
  EXPECT_EQ(report.color_view.gain_within_20, 1);
  // Half of the wall mirrors.
  const double matte =
      double(report.color_view_matte.raw.count) / double(report.color_view.raw.count);
  EXPECT_NEAR(matte, 0.5, 0.02);
}

TEST_F(EvaluateTruth, ColorsAreComparedWithTheAlbedo) {
  PointCloud points = WallScene::map(0.02);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.color[i] =
        points.position[i].y() < 0 ? TruthScene::matte_color() : TruthScene::glossy_color();
  }
  const TruthReport exact = evaluate(points);
  EXPECT_LT(exact.color_albedo.raw.mean, 0.6);  // the wall's middle belongs to both
  EXPECT_LT(exact.color_albedo_matte.raw.mean, 0.6);

  for (LogColor& c : points.color)
    c = to_rgb(to_float(c).cwiseProduct(Eigen::Vector3f(0.5f, 1, 1)));
  const TruthReport dark = evaluate(points);
  EXPECT_GT(dark.color_albedo.raw.mean, 50);
  EXPECT_LT(dark.color_albedo.gain.mean, 2);
  EXPECT_NEAR(dark.color_albedo_matte.raw.mean, TruthScene::matte_color().r / 2.0, 1);
}

TEST(EvaluateTruthScene, PointsAtEdgesAndHiddenOnesHaveNoViewColor) {
  const TruthScene scene(3);
  DepthImage depth = DriveTruth(scene.drive().info().path).depth(2, 1);
  const float wall = depth.at(0, 0);
  for (int y = 0; y < depth.height; ++y) {  // a pillar over columns 50 ... 99
    for (int x = 50; x < 100; ++x) depth.depth[std::size_t(y * depth.width + x)] = 0.5f * wall;
  }
  test::write_depth_png(scene.image_file("depth", 1), depth);
  const TruthReport report = evaluate_truth(scene.map(WallScene::map(0.02)), scene.drive(), {});
  const TruthReport free =
      evaluate_truth(scene.map(WallScene::map(0.02)), TruthScene(3).drive(), {});
  // Of 199 columns 50 are hidden and 2 on either side lie too near the edges.
  EXPECT_NEAR(double(report.color_view.raw.count) / double(free.color_view.raw.count),
              (199 - 54) / 199.0, 0.005);
  EXPECT_LT(report.color_view.raw.mean, 2);
}

TEST_F(EvaluateTruth, TheWorstFrameIsTheFarthestOff) {
  ScoredMap map = scene_->map(WallScene::map(0.1));
  map.frames[3].T_local_lidar.translation().z() += 0.2;
  map.frames[5].T_local_lidar.translation().z() -= 0.1;
  const TruthEvaluation evaluation = evaluate_truth_points(map, scene_->drive(), {});
  const TruthFrame* worst = worst_frame(evaluation.report);
  ASSERT_NE(worst, nullptr);
  EXPECT_EQ(worst->frame, 3);
  EXPECT_NEAR(worst->position_m, 0.2, 0.03);  // the alignment takes up some of it
  const auto json = nlohmann::json::parse(to_json(evaluation.report));
  EXPECT_EQ(json.at("worst_frame").at("frame"), 3);
  EXPECT_EQ(json.at("worst_frame").at("pose_m"), worst->position_m);
  EXPECT_EQ(worst_frame(TruthReport{}), nullptr);
  // What pictures need: an entry a coloured point, a pose a frame.
  EXPECT_EQ(evaluation.distance.size(), evaluation.points_true.size());
  EXPECT_EQ(evaluation.is_ghost.size(), evaluation.points_true.size());
  EXPECT_EQ(evaluation.poses.size(), 9u);
  EXPECT_EQ(to_json(evaluation.report), to_json(evaluate(map)));
}

TEST(EvaluateTruthScene, PointsOnWhatMovedAreGhosts) {
  const TruthScene scene(3);
  scene.write_returns(1, TruthScene::returns(1, /*board=*/true));
  PointCloud points = WallScene::map(0.02);
  const std::size_t on_wall = points.size();
  PointCloud board;
  for (float y = -0.4f; y < 0.45f; y += 0.1f) {
    for (float z = -0.4f; z < 0.45f; z += 0.1f) board.position.emplace_back(5.02f, y, z);
  }
  board.position.emplace_back(5.0f, 0, 3);  // in mid-air, but on nothing that moved
  board.color.assign(board.size(), Rgb{});
  board.camera.assign(board.size(), 2);
  board.frame.assign(board.size(), 1);
  points.append(board);
  ScoredMap map = scene.map(points);
  const TruthReport report = evaluate_truth(map, scene.drive(), {});
  EXPECT_EQ(report.ghosts, board.size() - 1);
  ASSERT_EQ(report.frames.size(), 3u);
  EXPECT_EQ(report.frames[1].ghosts, board.size() - 1);
  EXPECT_EQ(report.frames[2].ghosts, 0u);
  std::size_t of_frames = 0;
  for (const TruthFrame& frame : report.frames) of_frames += frame.points.value();
  EXPECT_EQ(of_frames, points.size());
  EXPECT_EQ(report.accuracy.count, on_wall + 1);
  EXPECT_NEAR(report.accuracy.max, 3, 1e-5);
  EXPECT_NEAR(report.shares.precision[3], double(on_wall) / double(points.size()), 1e-9);

  map.points_local.frame.assign(points.size(), 2);  // nothing moved there
  EXPECT_EQ(evaluate_truth(map, scene.drive(), {}).ghosts, 0u);
  map.points_local.frame.clear();
  const TruthReport unknown = evaluate_truth(map, scene.drive(), {});
  EXPECT_FALSE(unknown.ghosts);
  EXPECT_FALSE(unknown.frames[0].points);
  EXPECT_EQ(unknown.color_view.raw.count, 0u);
}

TEST_F(EvaluateTruth, UpsamplingFillsAPlaneExactly) {
  const TruthReport report = evaluate(WallScene::map(0.1));
  EXPECT_EQ(report.upsampling.frames, 9u);
  EXPECT_GT(report.upsampling.error.count, report.upsampling.hidden);
  EXPECT_LT(report.upsampling.error.max, 1e-5);
  EXPECT_GT(report.upsampling.hidden, 10'000u);
  EXPECT_GT(report.upsampling.recovered, 0.95);
}

TEST(EvaluateTruthScene, UpsamplingLeavesGapsBeyondItsReach) {
  const TruthScene scene(2, 1.2);  // rings that are kept lie 0.33 m apart at 8 m
  const TruthReport report = evaluate_truth(scene.map(WallScene::map(0.1)), scene.drive(), {});
  EXPECT_GT(report.upsampling.hidden, 100u);
  EXPECT_EQ(report.upsampling.error.count, 0u);
  EXPECT_EQ(report.upsampling.recovered, 0);
}

TEST_F(EvaluateTruth, GivesTheSameReportWithAnyNumberOfThreads) {
  const ScoredMap map = scene_->map(WallScene::map(0.03, 0.02));
  const std::string report = to_json(evaluate(map));
  const ThreadLimit one(1);
  EXPECT_EQ(to_json(evaluate(map)), report);
}

TEST_F(EvaluateTruth, TheReportIsJsonAndATable) {
  const TruthReport report = evaluate(WallScene::map(0.05));
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json.at("protocol"), "truth");
  EXPECT_EQ(json.at("aligned"), true);
  EXPECT_EQ(json.at("pose_aligned_m").at("rmse"), report.pose_aligned.position_m.rmse);
  EXPECT_EQ(json.at("accuracy_mean"), report.accuracy.mean);
  EXPECT_TRUE(json.at("accuracy_interpolated_mean").is_null());
  EXPECT_EQ(json.at("f_score_2cm"), report.shares.f_score[0]);
  EXPECT_EQ(json.at("completeness_20cm"), 1);
  EXPECT_EQ(json.at("color_view").at("points"), report.color_view.raw.count);
  EXPECT_EQ(json.at("ghosts"), 0);
  EXPECT_EQ(json.at("frames").size(), 9u);
  EXPECT_THAT(to_text(report), testing::HasSubstr("completeness"));
}

TEST(EvaluateTruthScene, AMapWithoutColorsIsScoredByAllItsPoints) {
  const TruthScene scene(2);
  const ScoredMap colored = scene.map(WallScene::map(0.1));
  ScoredMap uncolored = colored;
  uncolored.points_local.camera.assign(uncolored.points_local.size(), kNoCamera);
  uncolored.cameras.clear();
  const TruthReport report = evaluate_truth(uncolored, scene.drive(), {});
  const TruthReport with_colors = evaluate_truth(colored, scene.drive(), {});
  EXPECT_FALSE(report.colored);
  EXPECT_EQ(report.accuracy.count, colored.points_local.size());
  EXPECT_EQ(report.accuracy.mean, with_colors.accuracy.mean);
  EXPECT_EQ(report.color_albedo.raw.count, 0u);
  EXPECT_THAT(to_text(report), testing::HasSubstr("points (the map has no colors)"));
  EXPECT_THAT(to_text(report), testing::Not(testing::HasSubstr("albedo")));
}

TEST(EvaluateTruthScene, WhatIsMissingIsNamed) {
  const auto error = [](const ScoredMap& map, const FrameSource& drive) {
    try {
      evaluate_truth(map, drive, {});
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  const TruthScene scene(2);
  EXPECT_THAT(error(scene.map(WallScene::map(0.5)), WallDrive(2)), testing::HasSubstr("no truth"));
  EXPECT_THAT(error(scene.map(PointCloud()), scene.drive()), testing::HasSubstr("map is empty"));
  write_world({}, scene.truth());
  EXPECT_THAT(error(scene.map(WallScene::map(0.5)), scene.drive()),
              testing::HasSubstr("no surface"));
  std::filesystem::remove(scene.truth() / "world.json");
  EXPECT_THAT(error(scene.map(WallScene::map(0.5)), scene.drive()),
              testing::HasSubstr("world.json"));
}

}  // namespace fovea::evaluate_truth_test
