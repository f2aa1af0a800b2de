#include "fovea/pipeline/mapper.h"

#include <gtest/gtest.h>

#include <set>

#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::mapper_test {

/// The street, its walls not on borders of the map's cells: there rounding decides between two.
BoxScene street_off_borders() {
  BoxScene scene = street_scene();
  const Eigen::Vector3d shift(0.007, 0.006, 0.003);
  for (Box& box : scene.boxes) box.min += shift, box.max += shift;
  return scene;
}

/// Points that are in the cell of another one.
std::size_t crowded_points(const TileMap& map, double cell) {
  std::size_t crowded = 0;
  for (const Submap& submap : map.submaps()) {
    std::set<std::array<std::int64_t, 3>> cells;
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      for (const Eigen::Vector3f& position : tile.position) {
        const Eigen::Array3d at = ((tile.origin + position.cast<double>()) / cell).array().floor();
        crowded += !cells.insert({std::int64_t(at.x()), std::int64_t(at.y()), std::int64_t(at.z())})
                        .second;
      }
    }
  }
  return crowded;
}

TEST(Mapper, UpsampledPointsStayOnTheSurface) {
  Mapper mapper(street().info(), {}, PoseSource::kNavigation);
  const auto records = map_frames(mapper, street(), 0, 4);
  const auto points = points_of(mapper.map());
  std::size_t interpolated = 0, off = 0;
  for (const MapPoint& point : points) {
    interpolated += point.interpolated;
    off += street().scene.distance(point.p_local) > 0.02;
  }
  EXPECT_GT(interpolated, points.size() / 4);
  EXPECT_LT(double(off) / double(points.size()), 0.02);  // chords across corners, shorter than tau
  EXPECT_GT(records[0].figures.at("points_upsampled"), 2 * records[0].figures.at("points_foveal"));
}

TEST(Mapper, ManyViewsGiveTrueColorsAtOnePointACell) {
  const SyntheticDrive drive(street_off_borders(), 8, 0.8);
  MapperOptions options;  // one level: with more of them coarse points wait to be replaced
  options.surface.max_per_pixel = 0;
  options.foveal.periphery_range = 0;
  Mapper mapper(drive.info(), options, PoseSource::kNavigation);
  const auto records = map_frames(mapper, drive, 0, 8);
  double color_error = 0, views = 0;
  std::size_t wrong = 0, count = 0;
  for (const auto& [key, stored] : mapper.map().submaps()[0].tiles) {
    const PointCloud tile = stored.points->cloud();
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const Eigen::Vector3d p_local = mapper.map().submaps()[0].T_local_submap *
                                      (tile.origin + tile.position[i].cast<double>());
      const float error = (to_float(tile.color[i]) - synthetic_color(p_local)).norm();
      color_error += error;
      wrong += error > 15;  // a quarter of a metre off
      views += tile.views[i];
      ++count;
      ASSERT_GE(tile.views[i], 1);
      ASSERT_LE(tile.views[i], 8);
      ASSERT_GE(tile.weight[i], tile.views[i]);
    }
  }
  ASSERT_EQ(count, mapper.map().size());
  EXPECT_LT(color_error / double(count), 2.0);
  EXPECT_LT(double(wrong), 0.02 * double(count));
  EXPECT_GT(views / double(count), 2.0);
  EXPECT_GT(records[7].figures.at("points_recolored"), 10'000);
  EXPECT_GT(records[7].figures.at("texture_compared"), 1000);
  EXPECT_GT(records[7].figures.at("texture_error"), 0);
  EXPECT_LT(records[7].figures.at("texture_error"), 30);
  EXPECT_LT(double(crowded_points(mapper.map(), 4.0 / 192)), 1e-3 * double(count));
}

// However long a vehicle stands: also where cells end just where positions are rounded to (2 cm).
TEST(Mapper, AStandingVehicleAddsNothing) {
  for (const double spacing : {0.0185, 0.02, 0.03}) {
    SyntheticDrive drive(street_off_borders(), 4, 0);
    for (RigidMotion& T : drive.T_local_lidar) T = RigidMotion::Identity();
    MapperOptions options;
    options.surface.spacing = spacing;
    Mapper mapper(drive.info(), options, PoseSource::kGiven);
    std::vector<std::size_t> size;
    for (int i = 0; i < 4; ++i) {
      mapper.process(std::get<Frame>(drive.load(i)), {.given_pose = RigidMotion::Identity()});
      size.push_back(mapper.map().size());
    }
    EXPECT_LE(size[3], size[0] + size[0] / 2500) << spacing;
    EXPECT_GE(size[3], size[0] - size[0] / 1000) << spacing;  // without replaced points
  }
}

// The same scan and image again: nothing is new, and every point is seen again.
TEST(Mapper, AScanOfWhatIsMappedAddsViewsAndNoPoints) {
  SyntheticDrive drive(street_off_borders(), 10, 0);
  for (RigidMotion& T : drive.T_local_lidar) T = RigidMotion::Identity();
  Mapper mapper(drive.info(), {}, PoseSource::kGiven);
  std::size_t after_first = 0;
  for (int i = 0; i < 10; ++i) {
    mapper.process(std::get<Frame>(drive.load(i)), {.given_pose = RigidMotion::Identity()});
    if (i == 0) after_first = mapper.map().size();
  }
  ASSERT_GT(after_first, 50'000u);
  // In ten frames, however long it stands: floats at a cell's border.
  EXPECT_LE(mapper.map().size(), after_first + after_first / 2000);
  std::size_t seen_again = 0;
  for (const auto& [key, stored] : mapper.map().submaps()[0].tiles) {
    const PointCloud tile = stored.points->cloud();
    for (std::size_t i = 0; i < tile.size(); ++i) {
      ASSERT_LE(tile.views[i], 10);
      seen_again += tile.views[i] == 10;
      if (tile.views[i] == 10) {
        ASSERT_LE(tile.spread[i], 1);
      }
    }
  }
  EXPECT_GT(double(seen_again), 0.6 * double(after_first));
}

TEST(Mapper, WithoutPeripheryOnlyTheWhiteZoneIsTextured) {
  MapperOptions options;
  options.foveal.periphery_range = 0;
  Mapper mapper(street().info(), options, PoseSource::kNavigation);
  map_frames(mapper, street(), 0, 1);
  for (const MapPoint& point : points_of(mapper.map())) {
    const double range = (street().T_local_lidar[0].inverse() * point.p_local).norm();
    ASSERT_GT(range, 2.7);  // an interpolated point may lie a little inside its triangle's chord
    ASSERT_LT(range, 18.0);
  }
}

// The street has walls up to 40 m. As the vehicle comes nearer, finer points take the places of
// the coarse ones.
TEST(Mapper, ThePeripheryIsCoarseAndGivesWay) {
  Mapper mapper(street().info(), {}, PoseSource::kNavigation);
  const auto coarse_within = [&](int frame, double reach) {
    std::size_t coarse = 0;
    for (const auto& [key, stored] : mapper.map().submaps()[0].tiles) {
      const PointCloud tile = stored.points->cloud();
      for (std::size_t i = 0; i < tile.size(); ++i) {
        const Eigen::Vector3d p_submap = tile.origin + tile.position[i].cast<double>();
        const Eigen::Vector3d p_local = mapper.map().submaps()[0].T_local_submap * p_submap;
        const double range =
            (street().T_local_lidar[std::size_t(frame)].inverse() * p_local).norm();
        coarse += range < reach && tile.sampling_level[i] > 1;
      }
    }
    return coarse;
  };
  map_frames(mapper, street(), 0, 1);
  EXPECT_EQ(coarse_within(0, 12), 0u);
  const std::size_t far = coarse_within(0, 60) - coarse_within(0, 18);
  EXPECT_GT(far, 1000u);
  map_frames(mapper, street(), 1, 7);
  EXPECT_LT(coarse_within(6, 12), far / 20);
}

TEST(Mapper, HeldOutFramesAddNothingButGetAPose) {
  Mapper with(street().info(), {}, PoseSource::kRefine);
  const auto records = map_frames(with, street(), 0, 6, /*held_out=*/3);
  EXPECT_EQ(records[3].status, FrameStatus::kHeldOut);
  EXPECT_EQ(records[3].figures.count("points_added"), 0u);
  EXPECT_LT(
      (records[3].T_local_lidar.translation() - street().T_local_lidar[3].translation()).norm(),
      0.05);
  for (const MapPoint& point : points_of(with.map())) ASSERT_NE(point.frame, 3);

  // The frames after it are as if it had never been: its scan is no registration target either.
  SyntheticDrive without_it = street();
  Mapper without(without_it.info(), {}, PoseSource::kRefine);
  map_frames(without, without_it, 0, 3);
  const auto rest = map_frames(without, without_it, 4, 6);
  EXPECT_LT(
      (rest.back().T_local_lidar.translation() - records.back().T_local_lidar.translation()).norm(),
      1e-3);
}

// A frame without time for texture is tracked as any other, and leaves the map as it is.
TEST(Mapper, AFrameMayOnlyBeTracked) {
  const SyntheticDrive& drive = street();
  Mapper all(drive.info(), {}, PoseSource::kRefine), some(drive.info(), {}, PoseSource::kRefine);
  for (int i = 0; i < 6; ++i) {
    const Frame frame = std::get<Frame>(drive.load(i));
    const std::size_t before = some.map().size();
    const FrameResult expected = all.process(frame);
    const FrameResult result = some.process(frame, {.skips_texture = i == 3});
    EXPECT_EQ(result.poses.T_odom_lidar.matrix(), expected.poses.T_odom_lidar.matrix()) << i;
    EXPECT_EQ(record_of(result).has("texture_skipped"), i == 3);
    if (i == 3) EXPECT_EQ(some.map().size(), before);
  }
  EXPECT_LT(some.map().size(), all.map().size());
}

}  // namespace fovea::mapper_test
