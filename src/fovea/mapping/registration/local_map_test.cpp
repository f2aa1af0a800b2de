#include "fovea/mapping/registration/local_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "fovea/base/errors.h"
#include "fovea/mapping/registration/test_scenes.h"

namespace fovea::local_map_test {

using test::motion;

RegistrationCloud scan(std::uint64_t seed, const RigidMotion& T_local_lidar) {
  return prepare_cloud(test::transformed(T_local_lidar.inverse(),
                                         test::sample(test::room_corner(), 20, seed, 0.005)),
                       RegistrationOptions());
}

RigidMotion pose(int i) { return motion(0, 0, 0.02 * i, 0.2 * i, -0.1 * i, 0); }

TEST(LocalMap, IsAPureFunctionOfItsLastScans) {
  LocalMapOptions options;
  options.max_keyframes = 4;
  LocalMap whole(options), resumed(options);
  // 10 m a step: the origin moves, too.
  const auto pose = [](int i) { return motion(0, 0, 0.02 * i, 10.0 * i, -i, 0); };
  const auto scan = [&](int i, const RigidMotion& T) {
    return local_map_test::scan(static_cast<std::uint64_t>(i), pose(9).inverse() * T);
  };
  for (int i = 0; i < 10; ++i) whole.add(scan(i, pose(i)), pose(i));
  for (int i = 6; i < 10; ++i) resumed.add(scan(i, pose(i)), pose(i));
  EXPECT_GT(whole.target().origin_local.norm(), 50);
  EXPECT_GT(whole.size(), 300u);
  EXPECT_EQ(whole.size(), resumed.size());
  const LocalMap::Target& a = whole.target();
  const LocalMap::Target& b = resumed.target();
  EXPECT_EQ(a.origin_local, b.origin_local);
  for (const Eigen::Vector3f& p : b.cloud.points) {
    const Neighbor in_a = a.index.nearest(p, 0.01f), in_b = b.index.nearest(p, 0.01f);
    ASSERT_EQ(in_a.squared_distance, in_b.squared_distance);
    if (!std::isfinite(in_a.squared_distance)) continue;
    EXPECT_EQ(a.cloud.points[in_a.index], b.cloud.points[in_b.index]);
    EXPECT_EQ(a.cloud.normals[in_a.index], b.cloud.normals[in_b.index]);
  }

  const RegistrationCloud source = scan(99, pose(9));
  const RigidMotion guess = pose(9) * motion(0, 0, 0, 0.1, 0.1, 0);
  EXPECT_EQ(register_to(whole, source, guess, {}).T_target_source.matrix(),
            register_to(resumed, source, guess, {}).T_target_source.matrix());
}

TEST(LocalMap, ForgetsOldScans) {
  LocalMapOptions options;
  options.max_keyframes = 1;
  LocalMap map(options);
  map.add(scan(1, pose(1)), pose(1));
  map.add({{{5, 0, 0}}, {{-1, 0, 0}}}, RigidMotion::Identity());
  EXPECT_EQ(map.size(), 1u);
}

TEST(LocalMap, HoldsOnePointAVoxelWithinReach) {
  LocalMapOptions options;
  options.max_range = 5;
  options.voxel = 0.5;
  LocalMap map(options);
  for (int i = 0; i < 3; ++i) map.add(scan(i, pose(i)), pose(i));
  std::set<std::tuple<int, int, int>> voxels;
  for (const Eigen::Vector3f& p : map.target().cloud.points) {
    const Eigen::Vector3d p_local = p.cast<double>() + map.target().origin_local;
    const auto away = [&](int i) { return (p_local - pose(i).translation()).norm(); };
    EXPECT_LE(std::min({away(0), away(1), away(2)}), 5.0001);
    const Eigen::Vector3i v = (p / 0.5f).array().floor().cast<int>();
    EXPECT_TRUE(voxels.emplace(v.x(), v.y(), v.z()).second);
  }
  EXPECT_GT(voxels.size(), 300u);
}

TEST(LocalMap, TurnsNormalsWithTheScan) {
  LocalMap map{LocalMapOptions()};
  const RigidMotion T = motion(0, 0, 1.0, 3, 4, 5);
  map.add({{{5, 0, 0}}, {{-1, 0, 0}}}, T);
  const LocalMap::Target& target = map.target();
  EXPECT_LT(
      (target.cloud.points[0].cast<double>() + target.origin_local - T * Eigen::Vector3d(5, 0, 0))
          .norm(),
      1e-6);
  EXPECT_LT((target.cloud.normals[0].cast<double>() + T.linear().col(0)).norm(), 1e-6);
}

TEST(LocalMap, RegistersFarFromTheOriginOfItsFrame) {
  // 50 km out, floats in `local` itself would be good to 4 mm only.
  const RigidMotion far = motion(0, 0, 0.5, 50000, -30000, 200);
  LocalMap map{LocalMapOptions()};
  for (int i = 0; i < 4; ++i) map.add(scan(i, pose(i)), far * pose(i));
  const RigidMotion truth = far * pose(4);
  const RegistrationResult result = register_to(map, scan(44, pose(4)), far * pose(3), {});
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
  const RegistrationResult result = register_to(map, scan(1, pose(0)), RigidMotion::Identity(), {});
  EXPECT_FALSE(result.converged);
}

TEST(LocalMapOptions, ValidateNamesTheField) {
  EXPECT_NO_THROW(LocalMapOptions().validate());
  const auto expect_rejected = [](auto change, const char* field) {
    LocalMapOptions options;
    change(options);
    try {
      options.validate();
      ADD_FAILURE() << field << " was not rejected";
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(field));
    }
    EXPECT_THROW(LocalMap{options}, ConfigError);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_rejected([](LocalMapOptions& o) { o.max_keyframes = 0; }, "local_map.max_keyframes");
  expect_rejected([&](LocalMapOptions& o) { o.keyframe_distance = nan; },
                  "local_map.keyframe_distance");
  expect_rejected([](LocalMapOptions& o) { o.keyframe_rotation = 0; },
                  "local_map.keyframe_rotation");
  expect_rejected([](LocalMapOptions& o) { o.keyframe_overlap = 1.1; },
                  "local_map.keyframe_overlap");
  expect_rejected([](LocalMapOptions& o) { o.max_range = 0; }, "local_map.max_range");
  expect_rejected([&](LocalMapOptions& o) { o.voxel = nan; }, "local_map.voxel");
}

}  // namespace fovea::local_map_test
