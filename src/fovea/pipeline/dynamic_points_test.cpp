#include "fovea/pipeline/dynamic_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace fovea::dynamic_points_test {

/// A scan at rest: a wall all around at 20 m, and a box face at x = `face` (0: none), 2 m wide.
PointCloud scan_of(float face) {
  PointCloud scan;
  for (int ring = 0; ring < 64; ++ring) {
    const float elevation = (2.0f - 0.42f * float(ring)) * std::numbers::pi_v<float> / 180;
    for (int k = 0; k < 1800; ++k) {
      const float azimuth = (float(k) - 900) * std::numbers::pi_v<float> / 900;
      const Eigen::Vector3f ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3f on_face = ray * (face / ray.x());
      const bool hit = face > 0 && ray.x() > 0 && std::abs(on_face.y()) < 1;
      scan.position.push_back(hit ? on_face : Eigen::Vector3f(ray * 20));
    }
  }
  return scan;
}

std::vector<SensorView> seen(float face) { return {{RangeImage(scan_of(face).position)}}; }

/// Points of a face at x that a frame adds to a map.
PointCloud face_points(float x, int frame) {
  PointCloud points;
  for (float y = -0.9f; y < 0.9f; y += 0.05f) {
    for (float z = -1.0f; z < 0; z += 0.05f) points.position.push_back({x, y, z});
  }
  const std::size_t n = points.size();
  points.range.assign(n, x);
  points.incidence.assign(n, 0);
  points.color.assign(n, Rgb{});
  points.frame.assign(n, frame);
  points.camera.assign(n, 2);
  points.interpolated.assign(n, 0);
  points.views.assign(n, 1);
  points.spread.assign(n, 0);
  points.weight.assign(n, 1);
  points.reason.assign(n, 0);
  return points;
}

const RigidMotion kHere = RigidMotion::Identity();

TEST(DynamicPointFilter, RemovesAnObjectThatLeft) {
  DynamicPointFilter filter({});
  TileMap map(4.0);
  map.add_submap(kHere);
  map.add(face_points(10, 0));
  const std::size_t face = map.size();
  map.add(face_points(20, 0));  // the wall itself
  const std::size_t all = map.size();
  for (int frame = 1; frame <= 3; ++frame) {
    EXPECT_EQ(filter.observe(map, seen(0), kHere, kHere, frame), 0u) << "too few scans yet";
  }
  EXPECT_EQ(filter.observe(map, seen(0), kHere, kHere, 4), face);
  EXPECT_EQ(map.size(), all - face);
  EXPECT_EQ(filter.observe(map, seen(0), kHere, kHere, 5), 0u);
}

// With these tile sizes a voxel border differs between a product and a quotient.
TEST(DynamicPointFilter, RemovesPointsOnTheBorderOfAVoxel) {
  for (const auto& [tile_size, x] : {std::pair(10.1, 9.696f), {5.9, 2.95f}, {17.5, 8.75f}}) {
    DynamicPointFilter filter({});
    TileMap map(tile_size);
    map.add_submap(kHere);
    map.add(face_points(x, 0));
    const std::size_t all = map.size();
    std::size_t removed = 0;
    for (int frame = 1; frame <= 5; ++frame) {
      removed += filter.observe(map, seen(0), kHere, kHere, frame);
    }
    EXPECT_EQ(removed, all) << tile_size;
  }
}

// A road 1 m below the LiDAR: no ray sees through the lowest decimeters above it. Points there are
// removed with those above them; the road stays.
TEST(DynamicPointFilter, RemovesTheLowestPartOfAnObject) {
  PointCloud scan = scan_of(0);
  for (Eigen::Vector3f& p : scan.position) {
    if (p.z() < -1) p *= -1 / p.z();
  }
  DynamicPointFilter filter({});
  TileMap map(4.0);
  map.add_submap(kHere);
  PointCloud road = face_points(10, 0), face = face_points(10, 1);
  for (Eigen::Vector3f& p : road.position) p = {10 + p.z() / 2, p.y(), -1.0f};
  map.add(road);
  map.add(face);
  std::size_t removed = 0;
  for (int frame = 2; frame < 10; ++frame) {
    removed += filter.observe(map, {{RangeImage(scan.position)}}, kHere, kHere, frame);
  }
  EXPECT_EQ(removed, face.size());
  EXPECT_EQ(map.size(), road.size());
}

TEST(DynamicPointFilter, KeepsAnObjectThatIsSeenSometimes) {
  DynamicPointFilter filter({});
  TileMap map(4.0);
  map.add_submap(kHere);
  map.add(face_points(10, 0));
  for (int frame = 1; frame < 40; ++frame) {
    EXPECT_EQ(filter.observe(map, seen(frame % 4 == 0 ? 10.f : 0.f), kHere, kHere, frame), 0u);
  }
}

TEST(DynamicPointFilter, KeepsHiddenPoints) {
  DynamicPointFilter filter({});
  TileMap map(4.0);
  map.add_submap(kHere);
  map.add(face_points(10, 0));
  for (int frame = 1; frame < 20; ++frame) {
    EXPECT_EQ(filter.observe(map, seen(6), kHere, kHere, frame), 0u);
  }
}

TEST(DynamicPointFilter, ClassifiesPointsInFreeSpaceAsDynamic) {
  DynamicPointFilter filter({});
  TileMap map(4.0);
  map.add_submap(kHere);
  const auto marked = [&](float x) {
    const auto marks = filter.classify(face_points(x, 9), kHere);
    return std::count(marks.begin(), marks.end(), 1);
  };
  EXPECT_EQ(marked(10), 0) << "nothing is known yet";
  for (int frame = 0; frame < 6; ++frame) filter.observe(map, seen(0), kHere, kHere, frame);
  EXPECT_EQ(marked(10), std::int64_t(face_points(10, 9).size()));
  EXPECT_EQ(marked(20), 0);
  // After as many scans with the face it counts as static.
  for (int frame = 6; frame < 12; ++frame) filter.observe(map, seen(10), kHere, kHere, frame);
  EXPECT_EQ(marked(10), 0);
}

// Rays graze the road, and see nothing of the lowest part of an object. The lowest ring points 24
// degrees down: 2.2 m below the LiDAR at 5 m.
TEST(DynamicPointFilter, PointsBelowDynamicOnesAreDynamic) {
  DynamicPointFilter filter({});
  TileMap map(4.0);
  map.add_submap(kHere);
  for (int frame = 0; frame < 6; ++frame) filter.observe(map, seen(0), kHere, kHere, frame);
  const auto is_dynamic = [&](const std::vector<float>& heights) {
    PointCloud points;
    for (const float z : heights) points.position.push_back({5, 0, z});
    return filter.classify(points, kHere);
  };
  EXPECT_EQ(is_dynamic({-1.9f}), (std::vector<std::uint8_t>{1}));
  EXPECT_EQ(is_dynamic({-2.5f}), (std::vector<std::uint8_t>{0}));
  EXPECT_EQ(is_dynamic({-1.9f, -2.1f, -2.3f, -2.5f}), (std::vector<std::uint8_t>{1, 1, 1, 0}));
}

TEST(DynamicPointFilter, SwitchedOffItRemovesNothing) {
  DynamicPointOptions off;
  off.remove = false;
  DynamicPointFilter filter(off);
  TileMap map(4.0);
  map.add_submap(kHere);
  map.add(face_points(10, 0));
  for (int frame = 1; frame < 20; ++frame) {
    EXPECT_EQ(filter.observe(map, seen(0), kHere, kHere, frame), 0u);
  }
  const auto marks = filter.classify(face_points(10, 20), kHere);
  EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), 0);
}

TEST(DynamicPointFilter, ReplayedScansGiveTheSameDecision) {
  TileMap map(4.0);
  map.add_submap(kHere);
  map.add(face_points(10, 0));
  TileMap again = map;
  DynamicPointFilter first({}), resumed({});
  for (int frame = 1; frame <= 2; ++frame) first.observe(map, seen(0), kHere, kHere, frame);
  for (int frame = 1; frame <= 2; ++frame) resumed.replay(again, seen(0), kHere, kHere, frame);
  for (int frame = 3; frame <= 4; ++frame) {
    EXPECT_EQ(first.observe(map, seen(0), kHere, kHere, frame),
              resumed.observe(again, seen(0), kHere, kHere, frame));
  }
  EXPECT_EQ(map.size(), 0u);
  EXPECT_EQ(again.size(), 0u);
}

/// A wall at x = 10 right in front of the first LiDAR, which sees nothing else; the second one,
/// 12 m ahead of it, sees the box of scan_of(), with x from the first LiDAR.
std::vector<SensorView> seen_by_second(float face) {
  constexpr float kAhead = 12;
  PointCloud wall;
  for (float y = -8; y < 8; y += 0.05f) {
    for (float z = -3; z < 3; z += 0.05f) wall.position.emplace_back(10, y, z);
  }
  RigidMotion T_lidar_sensor = RigidMotion::Identity();
  T_lidar_sensor.translation().x() = kAhead;
  const PointCloud scan = scan_of(face > 0 ? face - kAhead : 0);
  return {{RangeImage(wall.position)}, {RangeImage(scan.position), T_lidar_sensor}};
}

TEST(DynamicPointFilter, EachLidarSeesFromItsOwnPlace) {
  DynamicPointFilter filter({});
  TileMap map(4.0);
  map.add_submap(kHere);
  for (int frame = 0; frame < 3; ++frame) {
    map.add(face_points(18, frame));
    EXPECT_EQ(filter.observe(map, seen_by_second(18), kHere, kHere, frame), 0u);
  }
  std::size_t removed = 0;
  for (int frame = 3; frame < 9; ++frame) {
    removed += filter.observe(map, seen_by_second(0), kHere, kHere, frame);
  }
  EXPECT_GT(removed, 0.5 * double(face_points(18, 0).size()));
}

TEST(DynamicPointFilter, ASurfaceThatOneLidarSeesStays) {
  DynamicPointFilter filter({});
  TileMap map(4.0);
  map.add_submap(kHere);
  std::size_t removed = 0;
  for (int frame = 0; frame < 9; ++frame) {
    if (frame < 3) map.add(face_points(8, frame));
    std::vector<SensorView> both = seen(8);
    both.push_back({RangeImage(scan_of(0).position)});  // sees through the box
    removed += filter.observe(map, std::move(both), kHere, kHere, frame);
  }
  EXPECT_EQ(removed, 0u);
}

}  // namespace fovea::dynamic_points_test
