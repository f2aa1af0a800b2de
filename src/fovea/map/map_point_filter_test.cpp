#include "fovea/map/map_point_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/map/point_files/point_stream.h"
#include "fovea/map/point_query.h"

namespace fovea::map_point_filter_test {

constexpr double kLidarHeight = 2.1;  // m, not that of a usual car
constexpr double kSlope = 0.1;

/// A street along x that rises by 10 %, 60 m long, with a wall of 8 m at y = 9.
double road_at(double x) { return 5 + kSlope * x; }

struct Street {
  std::vector<Eigen::Vector3d> road, roofs;  // p_local; the roofs are 8 m above the road
};

Street street_points() {
  Street street;
  for (double x = 0; x <= 60; x += 0.25) {
    for (double y = -6; y <= 6; y += 0.25) street.road.emplace_back(x, y, road_at(x));
    street.roofs.emplace_back(x, 9, road_at(x) + 8);
  }
  return street;
}

/// A map of one submap, whose frame is moved and turned in `local`.
RigidMotion T_local_submap() {
  return exp_se3((Twist() << 0.02, -0.05, 1.3, 40, -20, 3).finished());
}

class MapPointFilterTest : public testing::Test {
 protected:
  void write(bool states_height, const std::vector<Eigen::Vector3d>& points_local) {
    const auto writer = MapWriter::create(path(), true);
    writer->put_meta("map.tile_size_m", "4");
    DriveRecord drive;
    drive.name = "street";
    drive.end_frame = 31;
    writer->put_drive(0, drive);
    SensorRecord sensor;
    if (states_height) sensor.profile.height = kLidarHeight;
    writer->put_sensor(0, sensor);
    for (int i = 0; i <= 30; ++i) writer->put_frame(frame_at(i));
    TileMap map(4.0);
    map.add_submap(T_local_submap());
    std::vector<Eigen::Vector3f> positions;
    for (const Eigen::Vector3d& p : points_local) positions.push_back(p.cast<float>());
    map.add(one_point_each(positions));
    writer->put_submap(0, T_local_submap());
    for (const auto& [key, tile] : map.submaps()[0].tiles) writer->put_tile({0, key}, *tile.points);
    writer->commit();
  }
  /// The LiDAR along the middle of the road, one frame each 2 m.
  static FrameRecord frame_at(int i) {
    FrameRecord frame;
    frame.index = i;
    frame.T_local_lidar.translation() = Eigen::Vector3d(2 * i, 0, road_at(2 * i) + kLidarHeight);
    return frame;
  }
  /// All ways to read points give the same number.
  std::size_t count(const std::string& where) const {
    const MapReader map(path());
    const std::size_t read = map.all_points_local(PointFilter::parse(where)).size();
    EXPECT_EQ(find_points(map, {.where = where}).size(), read) << where;
    const PointChoice choice{.include_uncolored = true, .where = PointFilter::parse(where)};
    EXPECT_EQ(PointStream(map, choice).figures().points, read) << where;
    return read;
  }
  std::filesystem::path path() const { return folder_ / "street.fovea"; }
  TemporaryFolder folder_;
};

TEST_F(MapPointFilterTest, PlacesAreInLocalWhereverTheSubmapLies) {
  write(true, {{1.5, 2, 3}, {2.5, 2, 3}, {2.5, -4, 3}, {2.5, -4, 30}});
  EXPECT_EQ(count("x > 2"), 3u);
  EXPECT_EQ(count("x > 2 and y < 0"), 2u);
  EXPECT_EQ(count("x > 2 and y < 0 and z < 10"), 1u);
  EXPECT_EQ(count("z > 31"), 0u);
}

TEST_F(MapPointFilterTest, HeightsAreThoseAboveASlopingRoad) {
  const Street street = street_points();
  for (const bool states_height : {true, false}) {
    std::vector<Eigen::Vector3d> all = street.road;
    all.insert(all.end(), street.roofs.begin(), street.roofs.end());
    write(states_height, all);
    EXPECT_EQ(count("height > -0.05 and height < 0.05"), street.road.size()) << states_height;
    EXPECT_EQ(count("height > 7.95 and height < 8.05"), street.roofs.size()) << states_height;
  }
}

TEST_F(MapPointFilterTest, SkippedFramesAreNoPlacesOfThePath) {
  write(true, {{30, 0, road_at(30) + 1}});
  const auto writer = MapWriter::open(path());
  FrameRecord skipped = frame_at(15);
  skipped.status = FrameStatus::kSkipped;
  skipped.T_local_lidar.translation().z() += 50;
  writer->put_frame(skipped);
  writer->commit();
  EXPECT_EQ(count("height > 0.99 and height < 1.01"), 1u);
}

TEST_F(MapPointFilterTest, BeyondTheEndOfThePathTheRoadIsLevel) {
  write(true, {{100, 5, road_at(60) + 1}});
  EXPECT_EQ(count("height > 0.99 and height < 1.01"), 1u);
}

TEST_F(MapPointFilterTest, WithoutAPathNoHeightIsKnown) {
  write_sample_map(path());
  const auto writer = MapWriter::open(path());
  for (FrameRecord frame : sample_frames()) {
    frame.status = FrameStatus::kSkipped;
    writer->put_frame(frame);
  }
  writer->commit();
  EXPECT_EQ(count("height < 1e9"), 0u);
  EXPECT_EQ(count("height != 0"), 0u);
  EXPECT_GT(count("x < 1e9"), 0u);
}

}  // namespace fovea::map_point_filter_test
