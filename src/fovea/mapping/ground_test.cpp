#include "fovea/ground.h"

#include <gtest/gtest.h>

#include <numbers>

#include "fovea/mapping/registration/test_scenes.h"

namespace fovea::ground_test {

constexpr double kHeight = 1.73;

struct Street {
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint8_t> is_road;
};

/// A road below the sensor with a `slope` along x (rad), between house fronts, with cars on it.
Street street(double slope, double sigma = 0.01) {
  const Eigen::Vector3d up(-std::sin(slope), 0, std::cos(slope));
  const Eigen::Vector3d ahead(std::cos(slope), 0, std::sin(slope));
  const Eigen::Vector3d below(0, 0, -kHeight);
  const std::vector<test::Rectangle> road = {
      {below - 30 * ahead + Eigen::Vector3d(0, -8, 0), 60 * ahead, {0, 16, 0}}};
  std::vector<test::Rectangle> rest;
  for (const double y : {-8.0, 8.0}) {  // 40 cm above the road and up
    rest.push_back({below - 30 * ahead + Eigen::Vector3d(0, y, 0) + 0.4 * up, 60 * ahead, 6 * up});
  }
  for (const double x : {-15.0, 6.0, 18.0}) {  // a car's flank and its flat roof
    const Eigen::Vector3d foot = below + x * ahead + Eigen::Vector3d(0, 2, 0) + 0.4 * up;
    rest.push_back({foot, 4 * ahead, 1.1 * up});
    rest.push_back({foot + 1.1 * up, 4 * ahead, {0, 1.8, 0}});
  }
  Street result;
  for (const auto& p : test::sample(road, 8, 1, sigma)) {
    result.points.push_back(p);
    result.is_road.push_back(1);
  }
  for (const auto& p : test::sample(rest, 8, 2, sigma)) {
    result.points.push_back(p);
    result.is_road.push_back(0);
  }
  return result;
}

double share_right(const Street& street, const std::vector<std::uint8_t>& mask) {
  std::size_t right = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) right += mask[i] == street.is_road[i] ? 1 : 0;
  return static_cast<double>(right) / static_cast<double>(mask.size());
}

TEST(Ground, HeightThreshold) {
  const std::vector<Eigen::Vector3f> points = {
      {5, 0, -1.73f}, {5, 0, -1.49f}, {5, 0, -1.47f}, {5, 0, 0}, {5, 0, -3}};
  EXPECT_EQ(segment_ground(points, {}), (std::vector<std::uint8_t>{1, 1, 0, 0, 1}));
}

TEST(Ground, BothMethodsOnALevelStreet) {
  const Street level = street(0);
  for (const GroundMethod method : {GroundMethod::kHeight, GroundMethod::kRansac}) {
    GroundOptions options;
    options.method = method;
    EXPECT_GT(share_right(level, segment_ground(level.points, options)), 0.999);
  }
}

TEST(Ground, RansacFollowsASlopeThatTheThresholdMisses) {
  for (const double degrees : {-6.0, 4.0, 8.0}) {
    const Street sloped = street(degrees * std::numbers::pi / 180);
    GroundOptions options;
    EXPECT_LT(share_right(sloped, segment_ground(sloped.points, options)), 0.9);
    options.method = GroundMethod::kRansac;
    EXPECT_GT(share_right(sloped, segment_ground(sloped.points, options)), 0.995) << degrees;
  }
}

TEST(Ground, RansacFallsBackToTheThreshold) {
  GroundOptions height, ransac;
  ransac.method = GroundMethod::kRansac;
  // Steeper than the limit; walls only; too few points; none.
  const std::vector<std::vector<Eigen::Vector3f>> clouds = {
      test::sample({{{-15, -8, -9}, {30, 0, 15}, {0, 16, 0}}}, 8, 1),
      test::sample({{{5, -8, -1.7}, {0, 16, 0}, {0, 0, 5}}}, 8, 1),
      {{5, 0, -1.7f}, {6, 1, -1.7f}, {7, 0, 1}},
      {}};
  for (const auto& cloud : clouds) {
    EXPECT_EQ(segment_ground(cloud, ransac), segment_ground(cloud, height));
  }
}

TEST(Ground, RansacDependsOnTheSeedAlone) {
  const Street sloped = street(0.06, 0.03);
  GroundOptions options;
  options.method = GroundMethod::kRansac;
  EXPECT_EQ(segment_ground(sloped.points, options), segment_ground(sloped.points, options));
}

}  // namespace fovea::ground_test
