#include "fovea/evaluation/map_geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "fovea/core/random.h"

namespace fovea::map_geometry_test {

/// A square of 4 m, however it lies, with normal noise across it (m).
std::vector<Eigen::Vector3f> plane(double noise) {
  std::vector<Eigen::Vector3f> points;
  Random random(3);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  for (int i = 0; i < 40000; ++i) {
    const Eigen::Vector3d p(random.uniform(-2, 2), random.uniform(-2, 2), noise * random.normal());
    points.push_back((R * p).cast<float>());
  }
  return points;
}

TEST(PlaneThickness, IsTheNoiseOfAPlane) {
  for (const double noise : {0.0, 0.01, 0.02, 0.05}) {
    const PlaneThickness found = plane_thickness(plane(noise));
    EXPECT_GT(found.patches, 400u);
    EXPECT_NEAR(found.thickness, noise, 0.001 + 0.12 * noise) << noise;
  }
}

TEST(PlaneThickness, OfAHeapOrALineThereIsNone) {
  std::vector<Eigen::Vector3f> heap, line;
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    heap.emplace_back(float(random.uniform()), float(random.uniform()), float(random.uniform()));
    line.emplace_back(float(random.uniform(0, 5)), 0.01f, 0.01f);
  }
  EXPECT_EQ(plane_thickness(line).patches, 0u);
  EXPECT_LT(plane_thickness(heap).patches, 70u);  // its sides, at most
  EXPECT_TRUE(std::isnan(plane_thickness({}).thickness));
}

TEST(ScanScores, OfAHandfulOfPoints) {
  // Map points 0, 3, 8, 18 and 50 cm from the only scan point; scan points 4 and 30 cm off.
  std::vector<Eigen::Vector3f> map;
  for (const float x : {0.0f, 0.031f, 0.08f, 0.18f, 0.5f}) map.emplace_back(0.001f, x, 0.001f);
  const ScanScores scores = scan_scores(map, {{0.001f, 0, 0.001f}}, {0.04f, 0.3f});
  ASSERT_GE(scores.map_samples, 4u);
  EXPECT_NEAR(scores.precision[2],
              static_cast<double>(scores.map_samples - 1) / double(scores.map_samples), 1e-12);
  EXPECT_DOUBLE_EQ(scores.recall[0], 0.5);
  EXPECT_DOUBLE_EQ(scores.recall[2], 0.5);
  EXPECT_DOUBLE_EQ(scores.f_score[2], 2 * scores.precision[2] * 0.5 / (scores.precision[2] + 0.5));
  EXPECT_TRUE(std::isnan(scan_scores({}, {{0, 0, 0}}, {0.1f}).precision[0]));
}

}  // namespace fovea::map_geometry_test
