#include "fovea/pipeline/paper_mapper.h"

#include <gtest/gtest.h>

#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::paper_mapper_test {

// Noise-free scans at true poses, nothing interpolated: what remains is frames and half pixels.
TEST(PaperMapper, TruePosesGiveTheTrueSurfaceAndColours) {
  PaperOptions options;
  options.upsample.rate = 0;
  PaperMapper mapper(street().info(), options, PoseSource::kNavigation);
  map_frames(mapper, street(), 0, 4);
  const auto points = points_of(mapper.map());
  ASSERT_GT(points.size(), 5000u);
  double worst = 0, color_error = 0;
  for (const MapPoint& point : points) {
    worst = std::max(worst, street().scene.distance(point.p_local));
    color_error += (to_float(point.color) - synthetic_color(point.p_local)).norm();
  }
  EXPECT_LT(worst, 1e-3);
  // A point near a box's edge may be hidden from the camera by parallax; few are.
  EXPECT_LT(color_error / double(points.size()), 2.0);
}

// Tau holds wherever upsampling runs: also for the points that are registered.
TEST(PaperMapper, TauLimitsTheUpsamplingBeforeRegistration) {
  const auto registered_points = [](double max_edge) {
    PaperOptions options;
    apply_variant("E1", options);
    options.upsample.max_edge = max_edge;
    PaperMapper mapper(street().info(), options, PoseSource::kRefine);
    return map_frames(mapper, street(), 0, 1).front().figures.at("registration_points");
  };
  EXPECT_LT(registered_points(0.05), registered_points(0.3));
}

TEST(PaperMapper, BaselineKeepsTheWholeScanAndLeavesTheUnseenUncolored) {
  PaperOptions options;
  apply_variant("baseline-gicp", options);
  PaperMapper mapper(street().info(), options, PoseSource::kNavigation);
  const auto record = map_frames(mapper, street(), 0, 1)[0];
  EXPECT_EQ(mapper.map().size(), std::size_t(record.figures.at("points_scan")));
  std::size_t uncolored = 0;
  for (const MapPoint& point : points_of(mapper.map())) uncolored += point.camera == kNoCamera;
  EXPECT_EQ(double(uncolored), record.figures.at("points_unseen"));
  for (const MapPoint& point : points_of(mapper.map())) ASSERT_EQ(point.reason, 0);
  EXPECT_GT(uncolored, mapper.map().size() / 2);
}

// The street, driven through with navigation that is 10 % too slow: each method finds the steps.
TEST(PaperMapper, RegistrationToThePreviousScanCorrectsTheNavigation) {
  const SyntheticDrive drive = street_with_slow_navigation();
  for (const char* row : {"baseline-gicp", "baseline-plane", "E2", "E10"}) {
    PaperOptions options;
    apply_variant(row, options);
    PaperMapper mapper(drive.info(), options, PoseSource::kRefine);
    const auto records = map_frames(mapper, drive, 0, 8);
    EXPECT_LT(
        (records[7].T_local_lidar.translation() - drive.T_local_lidar[7].translation()).norm(),
        0.15)
        << row;  // navigation is 0.56 m off
  }
}

// The filter leaves fewer points than the scans have, and these lie on the surface.
TEST(PaperMapper, TheRayFilterLeavesNewSurface) {
  PaperMapper mapper(street().info(), PaperOptions(), PoseSource::kNavigation);
  std::size_t upsampled = 0, oblique = 0;
  for (int i = 0; i < 3; ++i) {
    const FrameResult result = mapper.process(std::get<Frame>(street().load(i)));
    const RayFilterStats& filter = result.ray_filter.value();
    EXPECT_EQ(filter.visible, result.added);
    EXPECT_EQ(filter.visible + filter.occluded + filter.shared + result.foveal->occluding,
              result.foveal->upsampled - result.foveal->oblique);
    EXPECT_EQ(filter.map_points > 0, i > 0);
    upsampled += result.foveal->upsampled, oblique += result.foveal->oblique;
  }
  EXPECT_LT(mapper.map().size(), upsampled - oblique);
  std::size_t off = 0;
  for (const MapPoint& point : points_of(mapper.map())) {
    off += street().scene.distance(point.p_local) > 0.02;
  }
  EXPECT_LT(double(off), 0.02 * double(mapper.map().size()));
}

TEST(PaperMapper, AResumedRunEqualsAnUninterruptedOne) {
  PaperOptions options;
  apply_variant("E1", options);
  PaperMapper whole(street().info(), options, PoseSource::kRefine);
  const auto records = map_frames(whole, street(), 0, 6, 3);
  PaperMapper first(street().info(), options, PoseSource::kRefine);
  const auto before = map_frames(first, street(), 0, 4, 3);
  PaperMapper second(street().info(), options, PoseSource::kRefine);
  second.resume(first.map(), before, street());
  const auto after = map_frames(second, street(), 4, 6, 3);
  EXPECT_EQ(records[5].T_local_lidar.matrix(), after[1].T_local_lidar.matrix());
  expect_same_maps(whole.map(), second.map());
}

}  // namespace fovea::paper_mapper_test
