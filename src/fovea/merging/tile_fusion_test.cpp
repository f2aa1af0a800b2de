// Maps of one wall each, at known places.
#include "fovea/merging/tile_fusion.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/camera_models.h"
#include "fovea/map/meta_keys.h"
#include "fovea/merging/keyframe_test_support.h"

namespace fovea::tile_fusion_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr GeodeticPoint kOrigin{49, 8.4, 115};
constexpr double kStep = 0.02;

/// What a made-up map shows.
struct Wall {
  std::string session = "2026-05-17";
  double east = 10;  ///< m, of the wall; it spans 1 m to the north and 0.5 m in height
  std::uint8_t views = 2;
  double log2_gain = 0;  ///< of its submap in the city
  double free = 0;       ///< m, range of the keyframes 5 m west of the wall; 0: none
  int camera = 0;        ///< of its drive
};

class TileFusionOf : public testing::Test {
 protected:
  TileFusionOf() { city_.origin = kOrigin; }

  /// Writes a map, and places it: the origin of its submap is the middle of tile 0,0.
  void add(const std::string& name, const Wall& wall) {
    const fs::path path = folder_ / (name + ".fovea");
    const auto writer = MapWriter::create(path, false);
    writer->put_meta(meta_key::kTileSize, "4");
    writer->put_meta(meta_key::kDriveName, name);
    writer->put_meta(meta_key::kComplete, "1");
    Camera camera;
    camera.index = wall.camera;
    camera.fx = camera.fy = 700;
    MapMeta cameras;
    store_camera_models({camera}, 0, cameras);
    for (const auto& [key, value] : cameras) writer->put_meta(key, value);
    DriveRecord drive;
    drive.name = name;
    drive.kind = "generic";
    drive.session = wall.session;
    drive.end_frame = 4;
    writer->put_drive(0, drive);
    writer->put_submap(0, RigidMotion::Identity());
    for (int k = 0; k < 4; ++k) put_frame(k, wall, *writer);
    put_wall(wall, *writer);
    writer->finish();
    maps_.push_back(path);
    place(path, name, wall.log2_gain);
  }

  void put_frame(int k, const Wall& wall, MapWriter& writer) const {
    FrameRecord frame;
    frame.index = k;
    frame.submap = 0;
    frame.T_local_lidar.translation() = Eigen::Vector3d(wall.east - 5, 0.2 * k, 0.2);
    writer.put_frame(frame);
    if (wall.free == 0) return;
    writer.put_keyframe(keyframe_of_range(k, wall.free));
  }

  static void put_wall(const Wall& wall, MapWriter& writer) {
    std::vector<Eigen::Vector3f> positions;
    const TileKey key{int(std::floor(wall.east / 4)), 0, 0};
    for (double north = 0.01; north < 1; north += kStep) {
      for (double up = 0.01; up < 0.5; up += kStep) {
        positions.emplace_back(float(wall.east - 4 * key.x), float(north), float(up));
      }
    }
    PointCloud points = one_point_each(positions);
    points.origin = Eigen::Vector3d(4.0 * key.x, 0, 0);
    TilePoints tile = TilePoints::of(points);
    for (FusedColor& color : tile.colors) color.views = wall.views;
    writer.put_tile({0, key}, tile);
  }

  void place(const fs::path& path, const std::string& name, double log2_gain) {
    const MapReader map(path);
    PlacedMap placed;
    placed.name = {map.identity(), name, 1};
    const GeodeticPoint middle = CityGrid(kOrigin, 64).middle({0, 0});
    placed.submaps.push_back({T_ecef_enu(middle), Eigen::Vector3d::Constant(log2_gain)});
    city_.maps.push_back(placed);
  }

  TileFusionJob job() const {
    TileFusionJob job;
    job.output = folder_ / "tile.fovea";
    job.force = true;
    return job;
  }
  TileFusionFigures fuse(const TileFusionJob& job) const { return fuse_tile(maps_, city_, job); }
  TileFusionFigures fuse() const { return fuse(job()); }
  /// Name of the first drive of the tile: the one whose colors count most.
  std::string first_drive() const {
    return MapReader(folder_ / "tile.fovea").drives().front().name;
  }

  TemporaryFolder folder_;
  std::vector<fs::path> maps_;
  CityPoses city_;
  const std::size_t wall_points_ = 50 * 25;
};

TEST_F(TileFusionOf, EachDriveKeepsItsCameras) {
  add("first", {.camera = 2});
  add("second", {.camera = 3});
  fuse();
  const MapReader tile(folder_ / "tile.fovea");
  ASSERT_EQ(tile.drives().size(), 2u);
  for (std::size_t drive = 0; drive < 2; ++drive) {
    const std::vector<Camera> cameras = camera_models(tile.meta(), drive);
    ASSERT_EQ(cameras.size(), 1u);
    EXPECT_EQ(cameras[0].index, tile.drives()[drive].name == "first" ? 2 : 3);
  }
}

TEST_F(TileFusionOf, AWallThatThreeDrivesShowIsThereOnce) {
  for (int k = 0; k < 3; ++k) add(fmt::format("drive_{}", k), {.east = 10 + 0.01 * k});
  const TileFusionFigures figures = fuse();
  EXPECT_EQ(figures.read, 3 * wall_points_);
  EXPECT_EQ(figures.points, wall_points_);
  EXPECT_EQ(figures.known, 2 * wall_points_);
  const MapReader tile(folder_ / "tile.fovea");
  EXPECT_EQ(tile.size(), wall_points_);
  for (const Eigen::Vector3f& p : tile.all_points_local().position) {
    EXPECT_NEAR(p.x(), 10.01, 0.0101);
  }
}

TEST_F(TileFusionOf, ADriveWhosePointsAreAllKnownKeepsItsFrames) {
  add("first", {.views = 3});
  add("second", {});
  fuse();
  const MapReader tile(folder_ / "tile.fovea");
  EXPECT_EQ(tile.size(), wall_points_);
  EXPECT_EQ(tile.frames().size(), 8u);
  EXPECT_EQ(tile.submaps().size(), 2u);
}

TEST_F(TileFusionOf, TheOrderOfTheMapsDoesNotCount) {
  for (int k = 0; k < 3; ++k) add(fmt::format("drive_{}", k), {.east = 10 + 0.03 * k});
  fuse();
  const std::string digest = MapReader(folder_ / "tile.fovea").digest();
  std::swap(maps_[0], maps_[2]);
  fuse();
  EXPECT_EQ(MapReader(folder_ / "tile.fovea").digest(), digest);
}

TEST_F(TileFusionOf, TheSessionDecidesWhoseColorsCount) {
  add("good", {.session = "2026-05-17", .views = 3});
  add("poor", {.session = "2026-05-18", .views = 1});
  fuse();
  EXPECT_EQ(first_drive(), "good");
  for (const char* session : {"latest", "2026-05-18", "poor"}) {
    TileFusionJob other = job();
    other.session = session;
    fuse(other);
    EXPECT_EQ(first_drive(), "poor") << session;
  }
  add("elsewhere", {.session = "2026-05-19", .east = 40});
  TileFusionJob other = job();
  other.session = "2026-05-19";  // has nothing in the tile
  fuse(other);
  EXPECT_EQ(first_drive(), "good");
  TileFusionJob wrong = job();
  wrong.session = "2025-01-01";
  EXPECT_THROW(fuse(wrong), InputError);
}

TEST_F(TileFusionOf, ColorsHaveTheExposureOfTheCity) {
  add("dark", {.log2_gain = 1});
  add("other", {.east = 20});
  fuse();
  const MapReader tile(folder_ / "tile.fovea"), map(maps_[0]);
  const auto code = [](const MapReader& reader, const TileId& id) {
    return int(reader.find_tile(id)->colors[0].color.code[0]);
  };
  const auto [id, points] = map.tile_sizes().front();
  int brightest = 0;
  for (const auto& [of_tile, count] : tile.tile_sizes()) {
    brightest = std::max(brightest, code(tile, of_tile));
  }
  EXPECT_NEAR(brightest - code(map, id), kColorCodesPerStop, 1);
}

TEST_F(TileFusionOf, WhatALaterDriveSeesThroughIsLeftOut) {
  add("before", {.session = "2026-05-17", .east = 10});
  add("after", {.session = "2026-05-18", .east = 20, .free = 0});
  EXPECT_EQ(fuse().parked, 0u);
  maps_.clear();
  city_.maps.clear();
  add("before_2", {.session = "2026-05-17", .east = 10});
  add("after_2", {.session = "2026-05-18", .east = 10.2, .free = 12});
  const TileFusionFigures figures = fuse();
  EXPECT_EQ(figures.parked, wall_points_);
  EXPECT_EQ(figures.points, wall_points_);
}

TEST_F(TileFusionOf, ADriveWithoutPointsInTheTileShowsFreeSpace) {
  add("before", {.session = "2026-05-17", .east = 30});
  add("after", {.session = "2026-05-18", .east = 34, .free = 12});  // its wall is in the next tile
  const TileFusionFigures figures = fuse();
  EXPECT_EQ(figures.maps, 1u);
  EXPECT_EQ(figures.parked, wall_points_);
}

TEST_F(TileFusionOf, ATileWithoutPointsIsAnErrorUnlessItIsAllowed) {
  add("drive", {});
  TileFusionJob empty = job();
  empty.tile = {50, 50};
  EXPECT_THROW(fuse(empty), InputError);
  EXPECT_FALSE(fs::exists(empty.output));
  empty.allow_empty = true;
  EXPECT_EQ(fuse(empty).points, 0u);
  EXPECT_NO_THROW(MapReader(empty.output).check());
}

TEST_F(TileFusionOf, AMapThatIsNotInThePosesIsRefused) {
  add("drive", {});
  city_.maps.clear();
  EXPECT_THROW(fuse(), InputError);
}

}  // namespace fovea::tile_fusion_test
