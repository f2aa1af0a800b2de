// Drives without cameras.
#include <gtest/gtest.h>

#include "fovea/pipeline/mapper_test_support.h"
#include "fovea/pipeline/paper_mapper.h"

namespace fovea::mapper_uncolored_test {

class MapperUncolored : public testing::Test {
 protected:
  MapperUncolored() : drive_(street_scene(), 6, 0.8) { drive_.editable_info().calibration = {}; }

  std::vector<MapPoint> map(const MapperOptions& options, int held_out = -1) {
    Mapper mapper(drive_.info(), options, PoseSource::kNavigation);
    records_ = map_frames(mapper, drive_, 0, 6, held_out);
    return points_of(mapper.map());
  }
  double worst_distance(const std::vector<MapPoint>& points) const {
    double worst = 0;
    for (const MapPoint& point : points) {
      worst = std::max(worst, drive_.scene.distance(point.p_local));
    }
    return worst;
  }

  SyntheticDrive drive_;
  std::vector<FrameRecord> records_;
};

TEST_F(MapperUncolored, SurfacesAllAroundAreSampledWithoutColors) {
  const std::vector<MapPoint> points = map({});
  ASSERT_GT(points.size(), 100'000u);
  std::size_t ahead = 0, behind = 0, interpolated = 0, off = 0;
  for (const MapPoint& point : points) {
    EXPECT_EQ(point.camera, kNoCamera);
    ahead += point.p_local.x() > 8;
    behind += point.p_local.x() < -4;
    interpolated += point.interpolated;
    off += drive_.scene.distance(point.p_local) > 0.05;
  }
  EXPECT_GT(ahead, 10'000u);
  EXPECT_GT(behind, 10'000u);
  EXPECT_GT(interpolated, points.size() / 2);
  EXPECT_LT(double(off), 0.02 * double(points.size()));
}

TEST_F(MapperUncolored, MeasuredPointsAreExactAndWithinTheFovealRanges) {
  MapperOptions options;
  options.foveal.far_range = 10;
  options.foveal.periphery_range = 0;
  std::size_t measured = 0;
  for (const MapPoint& point : map(options)) {
    if (point.interpolated) continue;
    ++measured;
    EXPECT_LT(drive_.scene.distance(point.p_local), 1.5e-3);
    const RigidMotion& T = drive_.T_local_lidar[std::size_t(point.frame)];
    const double range = (T.inverse() * point.p_local).norm();
    EXPECT_GT(range, options.foveal.near_range - 2e-3);
    EXPECT_LT(range, options.foveal.far_range + 2e-3);
  }
  EXPECT_GT(measured, 5'000u);
}

TEST_F(MapperUncolored, ABaselineKeepsEveryPoint) {
  PaperOptions options;
  apply_variant("baseline-icp", options);
  PaperMapper mapper(drive_.info(), options, PoseSource::kNavigation);
  double measured = 0;
  for (const FrameRecord& record : map_frames(mapper, drive_, 0, 6)) {
    measured += record.figures.at("points_scan");
  }
  const std::vector<MapPoint> points = points_of(mapper.map());
  EXPECT_EQ(double(points.size()), measured);
  EXPECT_LT(worst_distance(points), 1.5e-3);
}

TEST_F(MapperUncolored, HeldOutFramesAddNoPoint) {
  for (const MapPoint& point : map({}, 3)) ASSERT_NE(point.frame, 3);
}

TEST_F(MapperUncolored, IntensitiesAreKept) {
  Mapper mapper(drive_.info(), {}, PoseSource::kNavigation);
  map_frames(mapper, drive_, 0, 2);
  for (const auto& [key, stored] : mapper.map().submaps().front().tiles) {
    const PointCloud tile = stored.points->cloud();
    ASSERT_EQ(tile.intensity.size(), tile.size());
    for (const float intensity : tile.intensity) ASSERT_NEAR(intensity, 0.5, 1e-6);
  }
}

}  // namespace fovea::mapper_uncolored_test
