#include "fovea/map/colored_points.h"

#include <gtest/gtest.h>

namespace fovea::colored_points_test {

/// A square of edge 2 a, samples `spacing` apart, in a plane of any orientation.
std::vector<Eigen::Vector3f> plane(float a, float spacing, const Eigen::Vector3f& normal) {
  const Eigen::Quaternionf R = Eigen::Quaternionf::FromTwoVectors(Eigen::Vector3f::UnitZ(), normal);
  std::vector<Eigen::Vector3f> points;
  for (float x = -a; x <= a; x += spacing) {
    for (float y = -a; y <= a; y += spacing) points.push_back(R * Eigen::Vector3f(x, y, 0.033f));
  }
  return points;
}

TEST(ColoredPoints, LeaveOutUncolouredOnes) {
  PointCloud map;
  map.origin = {1, 2, 3};
  map.position = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  map.color = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  map.camera = {2, kNoCamera, 3};
  map.reason = {0, 1, 2};
  const ColoredPoints coloured = colored_points(map);
  EXPECT_EQ(coloured.origin, map.origin);
  ASSERT_EQ(coloured.position.size(), 2u);
  EXPECT_EQ(coloured.position[1], Eigen::Vector3f(2, 0, 0));
  EXPECT_EQ(coloured.color[1], (Rgb{3, 3, 3}));
  EXPECT_EQ(coloured.reason, (std::vector<std::uint8_t>{0, 2}));
}

TEST(PointRuns, BoundTheirPoints) {
  const std::vector<PointRun> runs =
      make_runs({{0, 0, 0}, {1, 2, 3}, {-1, 1, 1}, {5, 5, 5}, {9, 9, 9}}, 3);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].low, Eigen::Vector3f(-1, 0, 0));
  EXPECT_EQ(runs[0].high, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(runs[1].begin, 3u);
  EXPECT_EQ(runs[1].end, 5u);
  EXPECT_EQ(runs[0].distance_to({0, 1, 1}), 0);
  EXPECT_EQ(runs[0].distance_to({4, 6, 3}), 5);
  EXPECT_TRUE(make_runs({}, 3).empty());
}

TEST(SampleSpacing, IsThatOfAPlane) {
  for (const float spacing : {0.01f, 0.03f}) {
    const std::vector<Eigen::Vector3f> points = plane(1, spacing, {0, 0, 1});
    const std::vector<float> found = sample_spacing(points);
    EXPECT_NEAR(found[found.size() / 2], spacing, 0.1f * spacing);
  }
  EXPECT_FLOAT_EQ(sample_spacing({{5, 5, 5}})[0], 0.1f);
}

TEST(SampleSpacing, OfACoarseSurfaceClosesItAndOfAnIsolatedPointIsSmall) {
  constexpr double kCell = 0.02;
  ColoredPoints map;
  map.position = plane(2, 0.16f, {0, 0, 1});
  map.position.push_back({0, 0, 5});
  map.sampling_level.assign(map.position.size(), 3);
  map.sampling_level.back() = 1;
  const std::vector<float> spacing = sample_spacing(map, kCell);
  EXPECT_FLOAT_EQ(spacing.back(), float(kCell));  // half of a cell of 4 cm
  std::size_t closed = 0;
  for (std::size_t i = 0; i + 1 < spacing.size(); ++i) closed += spacing[i] > 0.11f;
  EXPECT_GT(double(closed), 0.7 * double(spacing.size()));  // the others are at the rim
}

TEST(SurfaceDensity, IsExactOnAPlaneHoweverItLies) {
  for (const Eigen::Vector3f& normal : std::vector<Eigen::Vector3f>{
           {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0.3f, -0.5f, 0.8f}}) {
    const std::vector<Eigen::Vector3f> map = plane(2, 0.01f, normal);
    const std::vector<Eigen::Vector3f> evaluated = plane(1, 0.037f, normal);
    EXPECT_NEAR(surface_density(map, evaluated), 10000, 200);
  }
}

TEST(SurfaceDensity, CountsHolesAsEmpty) {
  std::vector<Eigen::Vector3f> map = plane(2, 0.02f, {0, 0, 1});
  std::erase_if(map, [](const Eigen::Vector3f& p) { return p.x() < 0; });
  EXPECT_NEAR(surface_density(map, plane(1.5f, 0.05f, {0, 0, 1})), 1250, 60);
  EXPECT_EQ(surface_density({}, {{0, 0, 0}}), 0);
  EXPECT_TRUE(std::isnan(surface_density(map, {})));
}

TEST(SurfaceDensity, DoesNotDependOnHowDenselyThePlaneWasScanned) {
  // Half of the surface is mapped; the LiDAR saw that half a hundred times as often.
  const std::vector<Eigen::Vector3f> map = plane(1, 0.02f, {0, 0, 1});
  std::vector<Eigen::Vector3f> evaluated = plane(0.9f, 0.005f, {0, 0, 1});
  for (Eigen::Vector3f p : plane(0.9f, 0.05f, {0, 0, 1})) {
    p.x() += 5;
    evaluated.push_back(p);
  }
  EXPECT_NEAR(surface_density(map, evaluated), 1250, 60);
}

}  // namespace fovea::colored_points_test
