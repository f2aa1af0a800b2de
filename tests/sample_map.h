// Points, frames and a small map for tests of the map and of what reads it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "fovea/core/cloud_columns.h"
#include "fovea/core/random.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Points within +-half_size m, with all columns a map keeps; `frame` counts them from 0. Every
/// third is not coloured (camera -1), some incidences are unknown (NaN).
inline PointCloud random_map_points(std::size_t count, Random& random, double half_size) {
  PointCloud points;
  const auto coordinate = [&] { return static_cast<float>(random.uniform(-half_size, half_size)); };
  for (std::size_t i = 0; i < count; ++i) {
    const float x = coordinate(), y = coordinate(), z = coordinate();
    points.position.emplace_back(x, y, z);
    points.intensity.push_back(static_cast<float>(random.uniform()));
    points.range.push_back(static_cast<float>(random.uniform(3, 15)));
    points.incidence.push_back(i % 5 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                          : static_cast<float>(random.uniform(0, 1.5)));
    const std::uint64_t bits = random.next();
    points.color.push_back({std::uint8_t(bits), std::uint8_t(bits >> 8), std::uint8_t(bits >> 16)});
    points.frame.push_back(static_cast<std::int32_t>(i));
    points.camera.push_back(i % 3 == 0 ? kNoCamera : std::int8_t{2});
    points.interpolated.push_back(static_cast<std::uint8_t>(bits >> 24 & 1));
    points.views.push_back(i % 3 == 0 ? 0 : static_cast<std::uint8_t>(bits >> 32));
    points.spread.push_back(static_cast<std::uint8_t>(bits >> 40));
    points.weight.push_back(static_cast<std::uint16_t>(bits >> 48));
    points.reason.push_back(static_cast<std::uint8_t>(bits >> 25 & 0x13));
  }
  return points;
}

/// Points at these positions, coloured, without intensity; `frame` counts them from 0.
inline PointCloud one_point_each(const std::vector<Eigen::Vector3f>& positions) {
  PointCloud points;
  points.position = positions;
  points.range.assign(positions.size(), 5.f);
  points.incidence.assign(positions.size(), 0.f);
  points.color.assign(positions.size(), {1, 2, 3});
  points.camera.assign(positions.size(), 2);
  points.interpolated.assign(positions.size(), 0);
  points.views.assign(positions.size(), 1);
  points.spread.assign(positions.size(), 0);
  points.weight.assign(positions.size(), 1);
  points.saturated.assign(positions.size(), 0);
  points.reason.assign(positions.size(), 0);
  for (std::size_t i = 0; i < positions.size(); ++i) points.frame.push_back(int(i));
  return points;
}

/// Bit for bit, so that NaN equals itself.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline void expect_same_columns(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_TRUE(same_bits(a.position, b.position));
  for_each_optional_column(a, b, [](const char* name, const auto& left, const auto& right) {
    EXPECT_TRUE(same_bits(left, right)) << name;
  });
}

/// Two submaps with poses of many digits.
inline TileMap sample_tile_map(std::size_t points_per_submap = 2000) {
  Random random(11);
  TileMap map(4.0);
  for (int submap = 0; submap < 2; ++submap) {
    map.add_submap(exp_se3(
        (Twist() << 0.01, -0.02, 1.0 / 3 + submap, 100.0 / 7, 50.0 * submap, 1e-3).finished()));
    PointCloud points = random_map_points(points_per_submap, random, 12.0);
    points.origin = {10, 50.0 * submap, 0};
    map.add(points);
  }
  return map;
}

/// Frames 7, 8, 9: a mapped one with everything, a held-out one, a skipped one with nothing.
inline std::vector<FrameRecord> sample_frames() {
  std::vector<FrameRecord> frames(3);
  frames[0].index = 7;
  frames[0].stamp = 1'317'046'453'072'943'357;
  frames[0].T_local_lidar =
      exp_se3((Twist() << 0.1, 0.2, -3, 1e-17, 12345.678901234567, -5).finished());
  frames[0].T_local_lidar_navigation = exp_se3((Twist() << 1, 2, 0.5, 1, 2, 3).finished());
  frames[0].motion = SweepMotion{(Twist() << 1e-3, -2e-9, 1.0 / 3, 10.7, 0, -1e300).finished(),
                                 (Twist() << 0, 1e-7, -0.1, 4, 0, 2.5).finished()};
  frames[0].figures = {{"points_scan", 19'329}, {"a \"quoted\\\" name\n", 0.1}, {"b", -1e-300}};
  frames[0].milliseconds = {{"decode", 12.5}, {"frame", 1.0 / 7}};
  frames[0].views = {{2, frames[0].stamp, std::nullopt},
                     {3, 1'317'046'453'082'943'357, Eigen::Vector3d(0.25, -1.0 / 3, 1e-12)}};
  frames[0].views[1].response = {14.025, {-0.1, 1e-9, 1.0 / 7}};
  frames[0].views[1].log2_color = Eigen::Vector3d(6.5, 1.0 / 3, -1e-12);
  frames[0].views[1].revisit = {1, {0.5, -0.25, 1.0 / 3}};
  frames[1].index = 8;
  frames[1].status = FrameStatus::kHeldOut;
  frames[1].stamp = -5;
  frames[1].note = "a note, with 'quotes' and ünicode";
  frames[2].index = 9;
  frames[2].status = FrameStatus::kSkipped;
  return frames;
}

/// A drive with everything that a map can state of it.
inline DriveRecord sample_drive() {
  DriveRecord drive;
  drive.name = "a drive";
  drive.kind = "generic";
  drive.session = "2011-09-26";
  drive.calibration_fingerprint = "2:0123456789abcdef";
  drive.stamps_fingerprint = "0123456789abcdef0123456789abcdef";
  drive.first_frame = 7;
  drive.end_frame = 10;
  drive.frame_shift = -3;
  drive.T_local_drive = exp_se3((Twist() << 0, 0, 0.5, 1.0 / 3, 2, 3).finished());
  drive.origin = GeodeticPoint{49.011212804408, 8.4228850417969, 112.83492279053};
  drive.datum = kWgs84;
  drive.epoch_year = 2011.737;
  drive.height_type = HeightType::kOrthometric;
  return drive;
}

inline SensorRecord sample_sensor() {
  SensorRecord sensor;
  sensor.T_lidar_sensor = exp_se3((Twist() << 0.1, 0, 0, 0, 1.0 / 7, 0).finished());
  sensor.profile.name = "roof";
  sensor.profile.ring_elevations = {0.1, 0.05, -1.0 / 3};
  sensor.profile.ring_spacing = 1e-3;
  sensor.profile.point_spacing = 2.0 / 3000;
  sensor.profile.sweep = {0.05, SweepDirection::kCounterclockwise, -0.1, 1};
  sensor.profile.range_noise = 0.013;
  sensor.profile.height = 1.73;
  return sensor;
}

inline KeyframeRecord sample_keyframe() {
  return {7, 0, {0.1, -0.2}, 3, -3.1, 2.0 / 3, {0, 65535, 700, 701, 699, 1}};
}

inline CheckpointRecord sample_checkpoint() {
  return {9, {std::byte{1}, std::byte{0}, std::byte{255}}};
}

/// Of a submap with everything.
inline SubmapRecord sample_submap(const RigidMotion& T_local_submap) {
  SubmapRecord submap;
  submap.T_local_submap = T_local_submap;
  submap.covariance.emplace();
  for (int i = 0; i < 36; ++i) {
    const int row = i / 6, column = i % 6;
    (*submap.covariance)(row, column) = 1.0 / (1 + row + column);  // symmetric
  }
  return submap;
}

/// Puts it all, without commit.
inline void put_sample_map(MapWriter& writer, const TileMap& map) {
  writer.put_meta("origin.latitude_deg", "49.011212804408");
  writer.put_meta("origin.longitude_deg", "8.4228850417969");
  writer.put_meta("origin.height_m", "112.83492279053");
  writer.put_meta("map.tile_size_m", "4");
  writer.put_meta("config", "mapper = \"default\"\n");
  writer.put_meta("timing.total", "12.5");
  writer.put_drive(0, sample_drive());
  writer.put_sensor(0, sample_sensor());
  writer.put_keyframe(sample_keyframe());
  writer.put_checkpoint("tracker", sample_checkpoint());
  for (const FrameRecord& frame : sample_frames()) writer.put_frame(frame);
  for (std::size_t id = 0; id < map.submaps().size(); ++id) {
    writer.put_submap(id, sample_submap(map.submaps()[id].T_local_submap));
    for (const auto& [key, tile] : map.submaps()[id].tiles)
      writer.put_tile({id, key}, *tile.points);
  }
}

inline void write_sample_map(const std::filesystem::path& path) {
  const auto writer = MapWriter::create(path, false);
  put_sample_map(*writer, sample_tile_map());
  writer->commit();
}

/// Two points in one tile.
inline void write_map_without_intensity(const std::filesystem::path& path) {
  const auto writer = MapWriter::create(path, false);
  writer->put_meta("map.tile_size_m", "4");
  writer->put_submap(0, RigidMotion::Identity());
  writer->put_tile({0, {0, 0, 0}}, one_point_each({{1, 2, 3}, {3, 2, 1}}));
  writer->commit();
}

/// Points of the sample map in the order of its file, with their positions in the local frame.
inline void for_each_sample_point(
    const std::function<void(const Eigen::Vector3d& p_local, const PointCloud& tile,
                             std::size_t index)>& f) {
  const TileMap map = sample_tile_map();
  for (const Submap& submap : map.submaps()) {
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      for (std::size_t i = 0; i < tile.size(); ++i) {
        f(submap.T_local_submap * (tile.origin + tile.position[i].cast<double>()), tile, i);
      }
    }
  }
}

}  // namespace fovea
