// The evaluator on the real drive, against the simplest map there is: every point of the mapped
// scans in view, coloured by projection (docs/method.md 7, first row of the prototype's table).
#include <gtest/gtest.h>

#include "../../../tests/kitti_sample.h"
#include "fovea/evaluation/compare_color_rules.h"
#include "fovea/evaluation/training_views.h"

namespace fovea::kitti_evaluate_test {

/// Scans placed by navigation; frames with index % 8 == 4 add nothing.
ScoredMap keep_every_point(const FrameSource& drive) {
  ScoredMap map;
  const DriveInfo& info = drive.info();
  const HoldOut hold_out = HoldOut::parse("8:4");
  map.cameras = {info.calibration.cameras[0].index};
  map.points_local.origin = Eigen::Vector3d::Zero();
  for (int index = info.begin; index < info.end; ++index) {
    FrameRecord record;
    record.index = index;
    record.stamp = drive.stamp(index);
    record.status = hold_out.contains(index) ? FrameStatus::kHeldOut : FrameStatus::kMapped;
    const LoadedFrame loaded = drive.load(index);
    const auto* frame = std::get_if<Frame>(&loaded);
    const auto pose = record.stamp ? info.navigation->at(*record.stamp) : std::nullopt;
    if (frame == nullptr || !pose) {
      record.status = FrameStatus::kSkipped;
      map.frames.push_back(record);
      continue;
    }
    record.T_local_lidar = *pose;
    record.T_local_lidar_navigation = pose;
    record.motion = info.navigation->motion(*record.stamp, *record.stamp + kNsPerSecond / 20);
    map.frames.push_back(record);
    if (record.status == FrameStatus::kHeldOut) continue;
    const PlacedFrame placed{index, *pose, record.motion};
    const PointCloud scan = compensated_scan(frame->scan, placed, info);
    const EvaluatedView view =
        evaluated_view(frame->scan, scan, placed, info.calibration.cameras[0], frame->images[0],
                       map.points_local.origin);
    for (std::size_t i = 0; i < view.position.size(); ++i) {
      map.points_local.position.push_back(view.position[i]);
      map.points_local.color.push_back(to_rgb(view.color[i]));
      map.points_local.frame.push_back(index);
      map.points_local.camera.push_back(static_cast<std::int8_t>(view.camera));
    }
  }
  return map;
}

TEST(KittiEvaluate, FiguresOfTheKeepEveryPointMapAreThePrototypes) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(path);
  const std::unique_ptr<FrameSource> drive = open_drive(path, {});
  const ScoredMap map = keep_every_point(*drive);
  const EvaluationReport held_out = evaluate(map, *drive, {});
  RecordProperty("report", to_json(held_out));
  // Prototype: ME 0.0422, TE 29.2, median 17.6, within 20 0.545, MTME 1.64, coverage 0.793 with
  // refined poses; navigation poses are worse.
  EXPECT_NEAR(held_out.figures.me_mean, 0.042, 0.012) << to_text(held_out);
  EXPECT_NEAR(held_out.figures.te_mean, 30, 3);
  EXPECT_NEAR(held_out.figures.te_within_20, 0.55, 0.05);
  EXPECT_NEAR(held_out.figures.coverage_5cm, 0.75, 0.06);
  EXPECT_LT(held_out.figures.te_gain_mean, held_out.figures.te_mean + 1);
  EXPECT_LT(held_out.free_space.share(), 0.1);
  EXPECT_GT(held_out.gradients.sharpness(), 0.3);
  EXPECT_LT(held_out.gradients.sharpness(), 2);

  ProtocolOptions options;
  options.protocol = Protocol::kInSample;
  options.hold_out = HoldOut::parse("10-50");  // ten frames tell as much
  const EvaluationReport in_sample = evaluate(map, *drive, options);
  EXPECT_LT(in_sample.figures.me_mean, 1e-4);  // a map that keeps every point
  EXPECT_LT(in_sample.figures.te_mean, 1);
}

TEST(KittiEvaluate, RulesSeeTheColoursThatTheMapTookFromTheSameViews) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(path);
  const std::unique_ptr<FrameSource> drive = open_drive(path, {});
  const ScoredMap map = keep_every_point(*drive);
  const ColoredPoints points = colored_points(map.points_local);
  const std::vector<float> spacing = sample_spacing(points.position);
  std::size_t own = 0, same = 0, visible = 0;
  for (const FrameRecord& record : training_frames(map, drive->info(), {}, HoldOut::parse("8:4"))) {
    if (record.index % 10 != 1) continue;  // five of them
    for (const TrainingView& view : load_training_views(*drive, record, {0}, points, spacing, 0)) {
      const Eigen::Isometry3f T_cam_map =
          RigidMotion(view.T_cam_local * Eigen::Translation3d(points.origin)).cast<float>();
      for (std::size_t i = 0; i < points.position.size(); ++i) {
        if (map.points_local.frame[i] != record.index) continue;
        const auto seen =
            observation_of(view, T_cam_map, points.position[i], Eigen::Vector3f::Zero());
        if (!seen) continue;
        ++own;
        const Eigen::Vector3f difference = to_float(seen->color) - to_float(points.color[i]);
        same += difference.cwiseAbs().maxCoeff() <= 1 ? 1 : 0;
        visible += seen->visible ? 1 : 0;
      }
    }
  }
  EXPECT_GT(own, 30000u);
  EXPECT_GT(static_cast<double>(same), 0.999 * static_cast<double>(own));
  // The simplest map keeps what the camera cannot see beside the LiDAR, too.
  EXPECT_GT(static_cast<double>(visible), 0.85 * static_cast<double>(own));
}

TEST(KittiEvaluate, NoRuleIsBelowTheFloor) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(path);
  const std::unique_ptr<FrameSource> drive = open_drive(path, {});
  const auto scores = compare_color_rules(keep_every_point(*drive), *drive, {});
  const ErrorFigures& floor = scores.back().figures;
  for (const ColorRuleScore& score : scores) {
    EXPECT_EQ(score.figures.points, floor.points) << to_text(scores);
    EXPECT_GE(score.figures.te_mean, floor.te_mean) << to_text(scores);
  }
}

}  // namespace fovea::kitti_evaluate_test
