// A drive found in the tiles of a city, and the points around it.
#include "fovea/evaluation/scored_city.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "../../../tests/sample_map.h"
#include "../../../tests/synthetic_drive.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/map/map_meta.h"

namespace fovea::scored_city_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Tiles of 16 m in a row to the east. Each has four points of the drive "synthetic", four of
/// "other", and frames of both.
class ScoredCity : public testing::Test {
 protected:
  ScoredCity() : drive_(BoxScene{}, 10, 1.0) {
    city_.folder = folder_.path();
    city_.origin = {49, 8.4, 115};
    city_.tile_size = 16;
    drive_.editable_info().path = "anywhere/synthetic";
    for (int x : {0, 1, 8}) add_tile({x, 0});
  }

  static DriveRecord record(const std::string& name, int first_frame) {
    DriveRecord drive;
    drive.name = name;
    drive.source_digest = "map of " + name;
    drive.first_frame = first_frame;
    drive.end_frame = first_frame + 10;
    drive.frame_shift = first_frame;
    return drive;
  }

  /// The tile has the frames 0 to 3, or 3 to 6, or none of the drive. Its last one is held out.
  void add_tile(const CityTile& tile) {
    CityTileFile file;
    file.tile = tile;
    file.map = folder_ / (tile.text() + ".fovea");
    const RigidMotion T_tile_city = city_.T_local_tile(tile).inverse();
    const auto writer = MapWriter::create(file.map, false);
    writer->put_meta("map.tile_size_m", "4");
    const int first = 100 * (tile.x + 1);  // the numbers of frames differ from tile to tile
    writer->put_drive(0, record("synthetic", first));
    writer->put_drive(1, record("other", first + 10));
    for (int number = 3 * tile.x; number < 3 * tile.x + 4; ++number) {
      if (tile.x > 1) break;
      put_frame(first + number, SyntheticDrive::stamp_of(number), number == 3 * tile.x + 3,
                T_tile_city * RigidMotion(Eigen::Translation3d(4 * number, 4, 2)), *writer);
      put_frame(first + 10 + number, SyntheticDrive::stamp_of(number) + 5, false,
                T_tile_city * RigidMotion(Eigen::Translation3d(4 * number, 8, 2)), *writer);
    }
    std::vector<Eigen::Vector3f> positions;
    for (int i = 0; i < 8; ++i) positions.emplace_back(float(16 * tile.x + 1.5 * i + 1), 4.f, 1.f);
    PointCloud points = one_point_each(positions);
    for (int i = 0; i < 8; ++i) {
      points.frame[std::size_t(i)] = first + 3 * tile.x + (i < 4 ? i % 3 : 10 + i % 3);
    }
    TileMap map;
    map.add_submap(T_tile_city);
    map.add(transform_cloud(points, T_tile_city));
    writer->put_submap(0, T_tile_city);
    for (const auto& [key, stored] : map.submaps()[0].tiles)
      writer->put_tile({0, key}, *stored.points);
    writer->commit();
    file.points = points.size();
    city_.tiles.push_back(file);
  }

  static void put_frame(int index, TimeNs stamp, bool held_out, const RigidMotion& T_local_lidar,
                        MapWriter& writer) {
    FrameRecord frame;
    frame.index = index;
    frame.stamp = stamp;
    frame.status = held_out ? FrameStatus::kHeldOut : FrameStatus::kMapped;
    frame.submap = 0;
    frame.T_local_lidar = T_local_lidar;
    writer.put_frame(frame);
  }

  TemporaryFolder folder_;
  City city_;
  SyntheticDrive drive_;
};

TEST_F(ScoredCity, FindsEachFrameOfTheDriveOnce) {
  const DriveInCity found = find_drive_in_city(city_, drive_, /*foreign=*/false);
  EXPECT_EQ(found.name, "synthetic");
  EXPECT_EQ(found.numbers.size(), 1u);
  ASSERT_EQ(found.frames.size(), 7u);
  for (int i = 0; i < 7; ++i) {
    const FrameRecord& frame = found.frames[std::size_t(i)];
    EXPECT_EQ(frame.index, i);
    EXPECT_TRUE(frame.T_local_lidar.translation().isApprox(Eigen::Vector3d(4 * i, 4, 2), 1e-9));
    // Frame 3 is held out in the one tile, and mapped in the other one.
    EXPECT_EQ(frame.status, i == 6 ? FrameStatus::kHeldOut : FrameStatus::kMapped) << i;
  }
}

TEST_F(ScoredCity, LoadsThePointsAroundTheDrive) {
  const DriveInCity found = find_drive_in_city(city_, drive_, /*foreign=*/false);
  const ScoredMap map = load_scored_city(city_, found);
  ASSERT_EQ(map.points_local.size(), 16u);  // the third tile is too far away
  std::multiset<int> frames;
  for (std::size_t i = 0; i < map.points_local.size(); ++i) {
    const Eigen::Vector3d p = map.points_local.position[i].cast<double>() + map.points_local.origin;
    EXPECT_NEAR(p.y(), 4, 1e-3);
    EXPECT_NEAR(p.z(), 1, 1e-3);
    EXPECT_EQ(map.points_local.frame[i] >= 0, std::fmod(p.x(), 16) < 6.5) << p.x();
    frames.insert(map.points_local.frame[i]);
  }
  EXPECT_EQ(frames, (std::multiset<int>{-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 1, 2, 3, 3, 4, 5}));
  EXPECT_EQ(map.cameras, std::vector<int>{2});
  EXPECT_NEAR(map_origin(map.meta).value().latitude, 49, 1e-12);
}

TEST_F(ScoredCity, RefusesOtherDrives) {
  SyntheticDrive other(BoxScene{}, 10, 1.0);
  other.editable_info().path = "unknown";
  other.pause = kNsPerSecond / 50;  // no stamp is equal
  EXPECT_THAT([&] { find_drive_in_city(city_, other, /*foreign=*/false); },
              ThrowsMessage<InputError>(HasSubstr("was not made of the drive 'unknown'")));
  EXPECT_THAT([&] { find_drive_in_city(city_, other, /*foreign=*/true); },
              ThrowsMessage<InputError>(HasSubstr("was not made of the drive 'unknown'")));
  other.editable_info().path = "synthetic";
  EXPECT_EQ(find_drive_in_city(city_, other, /*foreign=*/true).frames.size(), 7u);
  other.editable_info().origin = GeodeticPoint{48, 8.4, 115};
  EXPECT_THAT([&] { find_drive_in_city(city_, other, /*foreign=*/false); },
              ThrowsMessage<InputError>(HasSubstr("lies outside of the city")));
}

TEST_F(ScoredCity, ACityWithoutPointsNearIsRefused) {
  DriveInCity found = find_drive_in_city(city_, drive_, /*foreign=*/false);
  for (FrameRecord& frame : found.frames) frame.T_local_lidar.translation().y() += 500;
  EXPECT_THAT([&] { load_scored_city(city_, found); },
              ThrowsMessage<InputError>(HasSubstr("no points near the drive 'synthetic'")));
}

}  // namespace fovea::scored_city_test
