#include "fovea/evaluation/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "../../../tests/tracklet_writer.h"
#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/evaluation/test_scene.h"

namespace fovea::evaluate_test {

/// The evaluated points of the drive's held-out frame 4, coloured truly: the perfect map.
PointCloud evaluated_points(const WallDrive& drive) {
  const Frame frame = std::get<Frame>(drive.load(4));
  PlacedFrame placed;
  placed.index = 4;
  placed.T_local_lidar = WallDrive::T_local_lidar(4);
  const EvaluatedView view =
      evaluated_view(frame.scan, frame.scan, placed, drive.info().calibration.cameras[0],
                     frame.images[0], Eigen::Vector3d::Zero());
  PointCloud points;
  points.position = view.position;
  for (const Eigen::Vector3f& color : view.color) points.color.push_back(to_rgb(color));
  points.camera.assign(points.size(), 2);
  return points;
}

EvaluationReport evaluate_held_out(PointCloud points, const WallDrive& drive = WallDrive()) {
  return evaluate(wall_map(std::move(points)), drive, {});
}

TEST(Evaluate, AMapOfTheEvaluatedPointsHasNoError) {
  const WallDrive drive;
  const EvaluationReport report = evaluate_held_out(evaluated_points(drive), drive);
  EXPECT_EQ(report.figures.points, report.map_points);
  EXPECT_GT(report.figures.points, 10000u);
  EXPECT_EQ(report.figures.me_mean, 0);
  EXPECT_LT(report.figures.te_mean, 0.6);  // colours are kept in 8 bits
  EXPECT_EQ(report.figures.te_within_20, 1);
  EXPECT_EQ(report.figures.coverage_5cm, 1);
  EXPECT_EQ(report.free_space.violating, 0u);
  EXPECT_EQ(report.frames, 1u);
  EXPECT_EQ(report.figures.te_mean, report.paper_like.te_mean);
}

TEST(Evaluate, AGoodMapOfTheWallScoresWell) {
  const EvaluationReport report = evaluate_held_out(WallScene::map(0.01));
  EXPECT_LT(report.figures.me_mean, 0.005);
  EXPECT_LT(report.figures.te_mean, 6);
  EXPECT_NEAR(report.gradients.sharpness(), 1, 0.1);
  EXPECT_NEAR(report.density_per_m2, 10000, 300);
  EXPECT_EQ(report.free_space.share(), 0);
  EXPECT_GT(report.free_space.tested, 100000u);
}

TEST(Evaluate, AGoodMapOfTheWallHasGoodStructure) {
  const EvaluationReport report = evaluate_held_out(WallScene::map(0.01));
  EXPECT_LT(report.thickness.thickness, 1e-4);
  EXPECT_GT(report.thickness.patches, 1000u);
  EXPECT_GT(report.scan_scores.f_score[0], 0.99);
  EXPECT_GT(report.pictures.psnr_covered(), 30);
  EXPECT_GT(report.pictures.mean_ssim_covered(), 0.95);
  EXPECT_EQ(report.shift.best(), Eigen::Vector2i(0, 0));
  EXPECT_NEAR(report.gradients.detail(), 1, 0.1);
  EXPECT_EQ(report.bleeding.points_edges, 0u);
  EXPECT_EQ(report.cross_view.points, 0u);  // one held-out view only
  EXPECT_EQ(evaluate_held_out(WallScene::map(0.01)).visible.left_out, 0u);

  const WallDrive drive(16);
  const EvaluationReport both = evaluate(wall_map(WallScene::map(0.01), 16), drive, {});
  EXPECT_GT(both.cross_view.points, 5000u);
  EXPECT_LT(both.cross_view.map, 0.15);  // nearest pixels: half a pixel off is up to 18 a channel
  EXPECT_LE(both.cross_view.floor, both.cross_view.map);
}

TEST(Evaluate, AShiftedTextureShowsInTheColorErrorOnly) {
  PointCloud shifted = WallScene::map(0.01);
  for (std::size_t i = 0; i < shifted.size(); ++i) {
    // Five pixels: 0.24 m on the wall.
    const Eigen::Vector3f& p = shifted.position[i];
    shifted.color[i] = to_rgb(WallScene::texture(p.y() + 0.24, p.z()));
  }
  const EvaluationReport report = evaluate_held_out(shifted);
  EXPECT_LT(report.figures.me_mean, 0.005);
  EXPECT_GT(report.figures.te_mean, 80);
  EXPECT_LT(report.figures.te_within_20, 0.3);
  EXPECT_NEAR(report.gradients.sharpness(), 1, 0.1);
}

TEST(Evaluate, AWrongExposureIsFittedByTheGains) {
  PointCloud dark = WallScene::map(0.01);
  for (LogColor& c : dark.color) c = to_rgb(0.5f * to_float(c));
  const EvaluationReport report = evaluate_held_out(dark);
  EXPECT_GT(report.figures.te_mean, 80);
  EXPECT_LT(report.figures.te_gain_mean, 7);
  EXPECT_GT(report.figures.te_gain_within_20, 0.99);
  ASSERT_EQ(report.views.size(), 1u);
  EXPECT_TRUE(report.views[0].gains.isApprox(Eigen::Vector3f::Constant(2), 0.01f));
}

TEST(Evaluate, AFattenedMapShowsInFreeSpaceViolations) {
  // Noise brings points nearer to the evaluated ones, which the sparse map's ME cannot tell from
  // gain.
  const EvaluationReport thin = evaluate_held_out(WallScene::map(0.02));
  const EvaluationReport fat = evaluate_held_out(WallScene::map(0.02, 0.4));
  EXPECT_EQ(thin.free_space.share(), 0);
  EXPECT_NEAR(fat.free_space.share(), 0.25, 0.02);  // 0.2-0.4 m before the wall, of -0.4 to 0.4
}

TEST(Evaluate, UncolouredPointsCountInThePaperLikeFiguresOnly) {
  const WallDrive drive;
  PointCloud points = evaluated_points(drive);
  const EvaluationReport coloured = evaluate_held_out(points, drive);
  PointCloud uncoloured = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.position[i].x() += 0.1f;
    uncoloured.camera[i] = kNoCamera;
  }
  points.append(uncoloured);
  const EvaluationReport report = evaluate_held_out(points, drive);
  EXPECT_NEAR(report.figures.me_mean, 0.1, 0.02);
  EXPECT_EQ(report.paper_like.me_mean, 0);
  EXPECT_GT(report.paper_like.te_mean, 200);
  EXPECT_NEAR(report.paper_like.te_mean, report.paper_like.te_gain_mean, 1e-6);
  EXPECT_EQ(report.figures.coverage_5cm < 0.5, true);
  EXPECT_EQ(report.map_points, 2 * report.map_points_coloured);
  EXPECT_EQ(report.map_points_coloured, coloured.map_points_coloured);
}

// Frame 4 lacks camera 3's image, frame 12 both.
TEST(Evaluate, MissingImagesScoreNothingAndAreTold) {
  Camera second = forward_camera();
  second.index = 3;
  WallDrive drive(16, {forward_camera(), second});
  const ScoredMap map = wall_map(WallScene::map(0.02), 16);
  ProtocolOptions options;
  options.cameras = {2, 3};
  const EvaluationReport whole = evaluate(map, drive, options);
  EXPECT_EQ(whole.views.size(), 4u);
  EXPECT_TRUE(whole.images_missing.empty());
  drive.lose_image(4, 3);
  drive.lose_image(12, 2);
  drive.lose_image(12, 3);
  const EvaluationReport report = evaluate(map, drive, options);
  ASSERT_EQ(report.views.size(), 1u);
  EXPECT_EQ(report.views[0].camera, 2);
  EXPECT_EQ(report.views[0].figures.te_mean, whole.views[0].figures.te_mean);
  EXPECT_EQ(report.frames, 1u);
  ASSERT_EQ(report.images_missing.size(), 1u);
  EXPECT_EQ(report.images_missing[0].frame, 4);
  EXPECT_EQ(report.images_missing[0].camera, 3);
  ASSERT_EQ(report.skipped.size(), 1u);
  EXPECT_EQ(report.skipped[0].index, 12);
}

TEST(Evaluate, GreyCamerasScoreIntensity) {
  WallDrive drive;
  drive.make_grey();
  const EvaluationReport report = evaluate_held_out(evaluated_points(drive), drive);
  EXPECT_LT(report.figures.te_mean, 0.5);
  PointCloud black = evaluated_points(drive);
  double mean = 0;
  for (LogColor& c : black.color) {
    mean += to_rgb(c).r;
    c = {};
  }
  mean /= static_cast<double>(black.size());
  EXPECT_NEAR(evaluate_held_out(black, drive).figures.te_mean, mean, 0.5);
}

TEST(Evaluate, ScoresEveryCameraOfEveryFrame) {
  Camera left = forward_camera(3);
  left.T_cam_lidar = RigidMotion(Eigen::Translation3d(0.5, 0, 0)) * left.T_cam_lidar;
  const WallDrive drive(16, {forward_camera(2), left});
  ScoredMap map = wall_map(WallScene::map(0.02), 16);
  ProtocolOptions options;
  options.cameras = {3, 2};
  const EvaluationReport report = evaluate(map, drive, options);
  ASSERT_EQ(report.views.size(), 4u);
  EXPECT_EQ(report.views[0].camera, 3);
  EXPECT_EQ(report.views[3].frame, 12);
  EXPECT_EQ(report.figures.points, report.views[0].figures.points + report.views[1].figures.points +
                                       report.views[2].figures.points +
                                       report.views[3].figures.points);
  EXPECT_LT(report.figures.te_mean, 12);
}

TEST(Evaluate, WhatMovedIsLeftOutOfBothSides) {
  // A board at x = 5 in frame 4's scan and another, of another colour, in the map from frame 3: a
  // labelled box that moved holds both. (The drive's scans have no board: the box cuts into the
  // wall.)
  TemporaryFolder folder;
  WallDrive drive;
  drive.mutable_info().path = folder.path();
  std::vector<test::BoxPose> poses;  // 4 m wide, moving along y; at frame 4 it stands at y = 0
  for (int i = 0; i < 9; ++i) poses.push_back({7.5 - 0.2 * i, i - 4.0, -1, 0});
  std::ofstream(folder / "tracklet_labels.xml")
      << test::tracklet_file({test::tracklet_item("Van", 2, 2, 2, 0, poses)});
  PointCloud points = WallScene::map(0.02);
  for (std::size_t i = 0; i < points.size(); ++i) {  // frame 3's box stands at y = -1
    const Eigen::Vector3f& p = points.position[i];
    points.frame[i] = 3;
    if (std::abs(p.y() + 1) < 1 && std::abs(p.z()) < 0.9f) points.color[i] = {255, 0, 255};
  }
  const EvaluationReport report = evaluate_held_out(points, drive);
  ASSERT_TRUE(report.without_moving);
  EXPECT_EQ(report.without_moving->moved, 1u);
  EXPECT_NEAR(static_cast<double>(report.without_moving->map_points_left_out), 110 * 110, 300);
  const SetFigures& standing = report.without_moving->set;
  EXPECT_EQ(standing.left_out + standing.figures.points, report.figures.points);
  EXPECT_GT(standing.left_out, 500u);
  // Left out of the map are y -2.1 to 0.1, of the scored points -1.1 to 1.1.
  EXPECT_LT(standing.figures.coverage_5cm, 0.97);
  EXPECT_GT(report.figures.coverage_5cm, 0.99);
  EXPECT_FALSE(evaluate_held_out(points).without_moving);
}

TEST(Evaluate, BlocksAreScoredWhereTrainingReached) {
  const WallDrive drive(40);  // 0.2 m a frame: frame 25 stands 3 m before the wall
  ScoredMap map = wall_map(WallScene::map(0.02), 40);
  for (FrameRecord& record : map.frames) {
    record.status = record.index >= 15 && record.index <= 24 ? FrameStatus::kHeldOut
                    : record.index < 15 && record.index > 9  ? FrameStatus::kMapped
                                                             : FrameStatus::kSkipped;
  }
  const EvaluationReport report = evaluate(map, drive, {});
  ASSERT_EQ(report.blocks.size(), 1u);
  EXPECT_EQ(report.blocks[0].first, 15);
  EXPECT_EQ(report.blocks[0].last, 24);
  EXPECT_EQ(report.blocks[0].figures.points, report.figures.points);
  EXPECT_EQ(report.unreached, 0u);  // from farther off all was in view
  for (FrameRecord& record : map.frames) {
    if (record.index < 15) record.status = FrameStatus::kSkipped;
    if (record.index == 25) record.status = FrameStatus::kMapped;
  }
  const EvaluationReport near = evaluate(map, drive, {});
  EXPECT_GT(near.unreached, 10 * near.figures.points / 100);
  EXPECT_EQ(near.unreached + near.figures.points, report.figures.points);
  EXPECT_TRUE(evaluate_held_out(WallScene::map(0.1)).blocks.empty());
}

TEST(Evaluate, CrossCameraScoresAnotherCamera) {
  Camera left = forward_camera(3);
  left.T_cam_lidar = RigidMotion(Eigen::Translation3d(0.5, 0, 0)) * left.T_cam_lidar;
  const WallDrive drive(9, {forward_camera(2), left});
  ProtocolOptions options;
  options.protocol = Protocol::kCrossCamera;
  options.cameras = {3};
  const EvaluationReport report = evaluate(wall_map(WallScene::map(0.01)), drive, options);
  EXPECT_EQ(report.cameras, std::vector<int>{3});
  EXPECT_LT(report.figures.te_mean, 6);
}

TEST(Evaluate, FramesThatCannotBeLoadedAreSkippedAndListed) {
  WallDrive drive(9);
  drive.lose(3);
  ProtocolOptions options;
  options.protocol = Protocol::kInSample;
  const EvaluationReport report = evaluate(wall_map(WallScene::map(0.1), 11), drive, options);
  EXPECT_EQ(report.frames, 7u);
  ASSERT_EQ(report.skipped.size(), 3u);
  EXPECT_EQ(report.skipped[0].index, 3);
  EXPECT_EQ(report.skipped[0].reason, "missing scan: no file");
  EXPECT_EQ(report.skipped[1].index, 9);
  EXPECT_EQ(report.skipped[1].reason, "not in the drive");
}

TEST(Evaluate, NothingToScoreIsAnError) {
  WallDrive drive;
  drive.lose(4);
  EXPECT_THROW(evaluate_held_out(WallScene::map(0.1), drive), InputError);
  EXPECT_THROW(evaluate_held_out(PointCloud()), InputError);
}

TEST(Evaluate, TheReportDoesNotDependOnTheNumberOfThreads) {
  const WallDrive drive(9);
  const ScoredMap map = wall_map(WallScene::map(0.05, 0.3), 9);
  ProtocolOptions options;
  options.protocol = Protocol::kInSample;
  std::vector<std::string> reports;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    reports.push_back(to_json(evaluate(map, drive, options)));
  }
  EXPECT_EQ(reports[0], reports[1]);
}

TEST(Evaluate, TellsItsProgressAndCanBeStopped) {
  const WallDrive drive(9);
  const ScoredMap map = wall_map(WallScene::map(0.1));
  ProtocolOptions options;
  options.protocol = Protocol::kInSample;
  std::vector<std::size_t> done;
  evaluate(map, drive, options, [&](std::size_t count, std::size_t total) {
    EXPECT_EQ(total, 8u);
    done.push_back(count);
  });
  EXPECT_THAT(done, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THROW(evaluate(map, drive, options,
                        [](std::size_t, std::size_t) { throw std::runtime_error("stop"); }),
               std::runtime_error);
}

}  // namespace fovea::evaluate_test
