#include "fovea/mapping/registration/local_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/registration/test_scenes.h"

namespace fovea::local_map_test {

using test::motion;

std::vector<Eigen::Vector3f> scan(std::uint64_t seed, const RigidMotion& T_local_lidar) {
  return test::transformed(T_local_lidar.inverse(),
                           test::sample(test::room_corner(), 20, seed, 0.005));
}

/// A prepared scan.
RegistrationCloud source(std::uint64_t seed, const RigidMotion& T_local_lidar) {
  return prepare_cloud(scan(seed, T_local_lidar), RegistrationOptions());
}

RigidMotion pose(int i) { return motion(0, 0, 0.02 * i, 0.2 * i, -0.1 * i, 0); }

TEST(LocalMap, IsAPureFunctionOfItsLastScans) {
  LocalMapOptions options;
  options.max_keyframes = 4;
  LocalMap whole(options), resumed(options);
  // Steps of 10 m: the origin moves, too.
  const auto pose = [](int i) { return motion(0, 0, 0.02 * i, 10.0 * i, -i, 0); };
  const auto scan = [&](int i, const RigidMotion& T) {
    return local_map_test::scan(static_cast<std::uint64_t>(i), pose(9).inverse() * T);
  };
  for (int i = 0; i < 10; ++i) whole.add(scan(i, pose(i)), pose(i));
  ASSERT_EQ(LocalMap::memory(options), 7);
  for (int i = 3; i < 10; ++i) resumed.add(scan(i, pose(i)), pose(i));
  EXPECT_GT(whole.target().origin_odom.norm(), 50);
  EXPECT_GT(whole.size(), 300u);
  EXPECT_EQ(whole.size(), resumed.size());
  const LocalMap::Target& a = whole.target();
  const LocalMap::Target& b = resumed.target();
  EXPECT_EQ(a.origin_odom, b.origin_odom);
  for (const Eigen::Vector3f& p : b.cloud.points) {
    const Neighbor in_a = a.index.nearest(p, 0.01f), in_b = b.index.nearest(p, 0.01f);
    ASSERT_EQ(in_a.squared_distance, in_b.squared_distance);
    if (!std::isfinite(in_a.squared_distance)) continue;
    EXPECT_EQ(a.cloud.points[in_a.index], b.cloud.points[in_b.index]);
    EXPECT_EQ(a.cloud.normals[in_a.index], b.cloud.normals[in_b.index]);
  }

  const RegistrationCloud source = local_map_test::source(99, pose(9));
  const RigidMotion guess = pose(9) * motion(0, 0, 0, 0.1, 0.1, 0);
  EXPECT_EQ(register_to(whole, source, guess, {}).T_target_source.matrix(),
            register_to(resumed, source, guess, {}).T_target_source.matrix());
}

TEST(LocalMap, RemovesOldScans) {
  LocalMapOptions options;
  options.max_keyframes = 1;
  LocalMap map(options);
  map.add(scan(1, pose(1)), pose(1));
  map.add({{5, 0, 0}}, RigidMotion::Identity());
  EXPECT_EQ(map.size(), 1u);
}

TEST(LocalMap, HoldsOnePointPerVoxelWithinMaxRange) {
  LocalMapOptions options;
  options.max_range = 5;
  options.voxel = 0.5;
  LocalMap map(options);
  for (int i = 0; i < 3; ++i) map.add(scan(i, pose(i)), pose(i));
  std::set<std::tuple<int, int, int>> voxels;
  for (const Eigen::Vector3f& p : map.target().cloud.points) {
    const Eigen::Vector3d p_local = p.cast<double>() + map.target().origin_odom;
    const auto away = [&](int i) { return (p_local - pose(i).translation()).norm(); };
    EXPECT_LE(std::min({away(0), away(1), away(2)}), 5.0001);
    const Eigen::Vector3i v = (p / 0.5f).array().floor().cast<int>();
    EXPECT_TRUE(voxels.emplace(v.x(), v.y(), v.z()).second);
  }
  EXPECT_GT(voxels.size(), 300u);
}

TEST(LocalMap, NormalsComeFromAllScansAroundAPoint) {
  // With each step away from the wall, a ring moves up the wall.
  const std::vector<test::Rectangle> wall = {{{30, -12, -3}, {0, 24, 0}, {0, 0, 12}}};
  const auto ring = [&](const RigidMotion& T) {
    return voxel_thinned(test::ring_scan(wall, T, {4 * std::numbers::pi / 180}, 1, 0.02), 0.25f);
  };
  const auto known = [](const LocalMap& map) {
    std::size_t with_plane = 0;
    for (const Eigen::Vector3f& normal : map.target().cloud.normals) {
      if (normal.isZero()) continue;
      EXPECT_GT(std::abs(normal.x()), std::cos(0.28f));  // four deviations
      ++with_plane;
    }
    return double(with_plane) / double(map.size());
  };
  LocalMap map{LocalMapOptions()};
  map.add(ring(motion(0, 0, 0, 0, 0, 0)), motion(0, 0, 0, 0, 0, 0));
  EXPECT_GT(map.size(), 50u);
  EXPECT_EQ(known(map), 0);
  for (const double x : {-3.0, -6.0, -9.0}) {
    map.add(ring(motion(0, 0, 0, x, 0, 0)), motion(0, 0, 0, x, 0, 0));
  }
  EXPECT_GT(known(map), 0.9);
}

// The rings on the ground look the same from any position. They must not pull toward no motion.
TEST(LocalMap, SparseRingsInAnOpenPlaceDoNotPull) {
  RegistrationOptions options;
  options.method = RegistrationMethod::kPointToPlane;
  options.robust_width = 0.1;
  const auto rings = [](int i, const RigidMotion& T) {
    return voxel_thinned(
        test::ring_scan(test::open_place(), T, test::sixteen_rings(), std::uint64_t(i), 0.03),
        0.25f);
  };
  const auto truth = [](int i) { return motion(0, 0, 0.01 * i, 0.9 * i, 0.05 * i, 0); };
  LocalMap map{LocalMapOptions()};
  map.add(rings(0, truth(0)), truth(0));
  RigidMotion last = truth(0), step = truth(0).inverse() * truth(1);
  for (int i = 1; i < 10; ++i) {
    std::vector<Eigen::Vector3f> points = rings(i, truth(i));
    const RegistrationResult result =
        register_to(map, select_points(points, 0), last * step, options);
    ASSERT_TRUE(result.converged) << i;
    const Twist error = log_se3(truth(i).inverse() * result.T_target_source);
    EXPECT_LT(error.tail<3>().norm(), 0.03) << i;
    EXPECT_LT(error.head<3>().norm(), 0.003) << i;
    step = last.inverse() * result.T_target_source;
    last = result.T_target_source;
    map.add(std::move(points), last);
  }
}

TEST(LocalMap, RegistersFarFromTheOriginOfItsFrame) {
  // At 50 km, floats in `local` have a resolution of 4 mm only.
  const RigidMotion far = motion(0, 0, 0.5, 50000, -30000, 200);
  LocalMap map{LocalMapOptions()};
  for (int i = 0; i < 4; ++i) map.add(scan(i, pose(i)), far * pose(i));
  const RigidMotion truth = far * pose(4);
  const RegistrationResult result = register_to(map, source(44, pose(4)), far * pose(3), {});
  EXPECT_TRUE(result.converged);
  const Twist error = log_se3(truth.inverse() * result.T_target_source);
  EXPECT_LT(error.tail<3>().norm(), 0.003);
  EXPECT_LT(error.head<3>().norm(), 0.001);
}

TEST(LocalMap, EmptyMapHasNoTarget) {
  LocalMap map{LocalMapOptions()};
  EXPECT_TRUE(map.empty());
  EXPECT_THROW(map.target(), std::logic_error);
  map.add({}, RigidMotion::Identity());
  EXPECT_FALSE(map.empty());
  const RegistrationResult result =
      register_to(map, source(1, pose(0)), RigidMotion::Identity(), {});
  EXPECT_FALSE(result.converged);
}

}  // namespace fovea::local_map_test
