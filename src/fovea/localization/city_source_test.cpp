// Surfaces and frames of a city, read tile by tile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/localization/surface_source.h"
#include "fovea/map/map_surfaces.h"

namespace fovea::city_source_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A point of the city's local frame each meter along x, 1 m above the ground of the origin.
class CitySource : public testing::Test {
 protected:
  CitySource() {
    city_.folder = folder_.path();
    city_.origin = {49, 8.4, 115};
    city_.tile_size = 16;
    for (int x = 0; x < 8; ++x) add_tile({x, 0});
  }

  /// A tile with the points that lie in it, and the frames of its tile and of the next one.
  void add_tile(const CityTile& tile) {
    CityTileFile file;
    file.tile = tile;
    file.map = folder_ / (tile.text() + ".fovea");
    const RigidMotion T_tile_city = city_.T_local_tile(tile).inverse();
    TileMap map;
    map.add_submap(T_tile_city);
    std::vector<Eigen::Vector3f> positions;
    for (double x = 16 * tile.x + 0.5; x < 16 * tile.x + 16; ++x) {
      positions.emplace_back(float(x), 4.f, 1.f);
    }
    map.add(transform_cloud(one_point_each(positions), T_tile_city));
    file.points = positions.size();
    const auto writer = MapWriter::create(file.map, false);
    writer->put_meta("map.tile_size_m", "4");
    DriveRecord drive;
    drive.name = "drive";
    drive.source_digest = "digest";
    drive.first_frame = 100;
    drive.end_frame = 200;
    drive.frame_shift = 100 - tile.x;  // frames of a tile begin at 100
    writer->put_drive(0, drive);
    for (int i = 0; i < 2; ++i) {
      FrameRecord frame;
      frame.index = 100 + i;
      frame.submap = 0;
      frame.T_local_lidar =
          T_tile_city * RigidMotion(Eigen::Translation3d(16 * (tile.x + i) + 8, 4, 2));
      writer->put_frame(frame);
    }
    writer->put_submap(0, T_tile_city);
    for (const auto& [key, points] : map.submaps()[0].tiles)
      writer->put_tile({0, key}, *points.points);
    writer->commit();
    city_.tiles.push_back(file);
  }

  TemporaryFolder folder_;
  City city_;
};

TEST_F(CitySource, ABallHasThePointsOfAllTilesInIt) {
  for (const std::size_t most_open : {std::size_t{1}, std::size_t{2}, kMostOpenTiles}) {
    const auto source = city_surface_source(city_, most_open);
    for (const double x : {16.0, 30.0, 96.0, 17.0}) {
      const Eigen::Vector3d center(x, 4, 1);
      std::vector<float> along;
      for (const Eigen::Vector3f& p : source->points_near(center, 20.2)) {
        EXPECT_NEAR(p.y(), 0, 1e-3);
        EXPECT_NEAR(p.z(), 0, 1e-3);
        along.push_back(p.x());
      }
      std::sort(along.begin(), along.end());
      const double first = std::max(0.5, std::ceil(x - 20.2 - 0.5) + 0.5);
      ASSERT_EQ(along.size(), static_cast<std::size_t>(x + 20.2 - first) + 1) << x;
      for (std::size_t i = 0; i < along.size(); ++i) {
        EXPECT_NEAR(along[i], first + double(i) - x, 1e-3);
      }
    }
  }
}

TEST_F(CitySource, AFrameInSeveralTilesCountsOnce) {
  const auto source = city_surface_source(city_);
  const std::vector<FrameRecord> near = source->new_frames_near({-90, 4, 1});  // 100 m: one tile
  ASSERT_EQ(near.size(), 2u);
  EXPECT_NEAR(near[1].T_local_lidar.translation().x(), 24, 1e-6);
  EXPECT_EQ(near[1].index, 1);
  EXPECT_TRUE(source->new_frames_near({-90, 4, 1}).empty());
  EXPECT_EQ(source->new_frames().size(), 7u);  // 0 to 8 without these two
  EXPECT_TRUE(source->new_frames().empty());
}

TEST_F(CitySource, ADamagedTileCountsOnlyWhereItIsNeeded) {
  std::ofstream(city_.tiles[7].map) << "no map";
  const auto source = city_surface_source(city_);
  EXPECT_FALSE(source->points_near({16, 4, 1}, 20).empty());
  EXPECT_THAT([&] { source->points_near({120, 4, 1}, 20); },
              ThrowsMessage<InputError>(HasSubstr("7,0.fovea")));
}

TEST_F(CitySource, ACityWithoutPointsIsRefused) {
  for (CityTileFile& tile : city_.tiles) tile.points = 0;
  EXPECT_THAT([&] { city_surface_source(city_); },
              ThrowsMessage<InputError>(HasSubstr("the city has no points")));
}

}  // namespace fovea::city_source_test
