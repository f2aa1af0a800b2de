// Maps that play against single figures, planted on purpose.
#include "fovea/evaluation/warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/evaluation/evaluate.h"
#include "fovea/evaluation/test_scene.h"

namespace fovea::warnings_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> warnings_of(PointCloud points) {
  return evaluate(wall_map(std::move(points)), WallDrive(), {}).warnings;
}

TEST(Warnings, AnHonestMapHasNone) {
  EXPECT_THAT(warnings_of(WallScene::map(0.01)), IsEmpty());
  EXPECT_THAT(warnings_of(WallScene::map(0.03, 0.03)), IsEmpty());
}

TEST(Warnings, AMapOfTheScoredScansThemselves) {
  const WallDrive drive;
  const Frame frame = std::get<Frame>(drive.load(4));
  const PlacedFrame placed{4, WallDrive::T_local_lidar(4), {}};
  const EvaluatedView view =
      evaluated_view(frame.scan, frame.scan, placed, drive.info().calibration.cameras[0],
                     frame.images[0], Eigen::Vector3d::Zero());
  PointCloud points;
  points.position = view.position;
  for (const Eigen::Vector3f& color : view.color) points.color.push_back(to_rgb(color));
  points.camera.assign(points.size(), 2);
  EXPECT_THAT(warnings_of(points), ElementsAre(HasSubstr("hold the scored scans")));
}

TEST(Warnings, DroppedPoints) {
  PointCloud kept;
  const PointCloud all = WallScene::map(0.01);
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (all.position[i].y() < 2 || all.position[i].y() > 4.5f) indices.push_back(i);
  }
  EXPECT_THAT(warnings_of(all.select(indices)), ElementsAre(HasSubstr("holes")));
}

TEST(Warnings, PointsDroppedAtEdgesOfDepth) {
  EvaluationReport report;
  report.bleeding = {100, 30, 25, 0.4, 0.9};
  EXPECT_THAT(warnings(report), ElementsAre(HasSubstr("dropped")));
  report.protocol = Protocol::kInSample;  // says nothing of quality anyway
  EXPECT_THAT(warnings(report), IsEmpty());
}

TEST(Warnings, ColorsThatBleedOverEdges) {
  EvaluationReport report;
  report.bleeding = {100, 80, 20, 0.9, 0.9};
  EXPECT_THAT(warnings(report), ElementsAre(HasSubstr("bleed")));
}

TEST(Warnings, ShiftedColors) {
  PointCloud shifted = WallScene::map(0.01);
  for (std::size_t i = 0; i < shifted.size(); ++i) {  // five pixels: 0.24 m on the wall
    const Eigen::Vector3f& p = shifted.position[i];
    shifted.color[i] = to_rgb(WallScene::texture(p.y() + 0.24, p.z()));
  }
  EXPECT_THAT(warnings_of(shifted), testing::Contains(HasSubstr("(5, 0) pixels beside")));
}

TEST(Warnings, FattenedPositions) {
  // Evenly spread over +-8.7 cm: a deviation of 5 cm.
  EXPECT_THAT(warnings_of(WallScene::map(0.01, 0.087)),
              testing::Contains(HasSubstr("thick (RMS)")));
  EXPECT_THAT(warnings_of(WallScene::map(0.01, 0.4)), testing::Contains(HasSubstr("saw through")));
}

TEST(Warnings, BlurredColors) {
  PointCloud blurred = WallScene::map(0.01);
  for (LogColor& color : blurred.color) {  // what a wide blur leaves of a sine
    color = to_rgb(0.4f * to_float(color) + Eigen::Vector3f::Constant(0.6f * 128));
  }
  EXPECT_THAT(warnings_of(blurred), ElementsAre(HasSubstr("sharpness is 0.4")));
}

TEST(Warnings, LittleOfThePhotographsDetail) {
  EvaluationReport report;
  report.gradients = {100, 10, 10, 20, 100};  // sharp enough, but of noise
  EXPECT_THAT(warnings(report), ElementsAre(HasSubstr("repeats 20% of the photographs' detail")));
}

TEST(Warnings, PosesThatStrayFromTheCourse) {
  ScoredMap map = wall_map(WallScene::map(0.02), 40);
  std::vector<PlacedFrame> scored;
  for (FrameRecord& record : map.frames) {
    record.T_local_lidar_navigation = record.T_local_lidar;
    // The registration corrects a slow drift of the navigation, and has 1 cm of jitter of its own.
    record.T_local_lidar.translation() +=
        Eigen::Vector3d(0, 0.02 * record.index, record.index % 2 == 0 ? 0.01 : 0);
    if (record.status == FrameStatus::kHeldOut) scored.push_back({record.index, {}, {}});
  }
  EvaluationReport report;
  report.stray = pose_stray(map.frames, scored);
  EXPECT_NEAR(report.stray.mapped, 0.01, 1e-9);
  EXPECT_NEAR(report.stray.scored, 0.01, 1e-9);
  EXPECT_THAT(warnings(report), IsEmpty());
  for (const PlacedFrame& placed : scored) {
    map.frames[placed.index].T_local_lidar.translation() += Eigen::Vector3d(0.1, 0, 0);
  }
  report.stray = pose_stray(map.frames, scored);
  EXPECT_NEAR(report.stray.scored, 0.1, 0.01);
  EXPECT_THAT(warnings(report), ElementsAre(HasSubstr("stray 0.10 m")));
  for (FrameRecord& record : map.frames) record.T_local_lidar_navigation.reset();
  EXPECT_TRUE(std::isnan(pose_stray(map.frames, scored).scored));
}

}  // namespace fovea::warnings_test
