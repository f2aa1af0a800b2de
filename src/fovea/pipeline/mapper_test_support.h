// Drives and maps for tests of the mapper.
#pragma once

#include <vector>

#include "../../../tests/sample_map.h"
#include "../../../tests/synthetic_drive.h"
#include "fovea/pipeline/mapper.h"

namespace fovea {

struct MapPoint {
  Eigen::Vector3d p_local;
  Rgb color;
  int frame = 0;
  std::int8_t camera = kNoCamera;
  bool interpolated = false;
  std::uint8_t reason = 0;
};

inline std::vector<MapPoint> points_of(const TileMap& map) {
  std::vector<MapPoint> points;
  for (const Submap& submap : map.submaps()) {
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      for (std::size_t i = 0; i < tile.size(); ++i) {
        points.push_back({submap.T_local_submap * (tile.origin + tile.position[i].cast<double>()),
                          to_rgb(tile.color[i]), tile.frame[i], tile.camera[i],
                          tile.interpolated[i] != 0, tile.reason[i]});
      }
    }
  }
  return points;
}

inline std::vector<FrameRecord> map_frames(IncrementalMapper& mapper, const SyntheticDrive& drive,
                                           int begin, int end, int held_out = -1) {
  std::vector<FrameRecord> records;
  for (int i = begin; i < end; ++i) {
    records.push_back(
        record_of(mapper.process(std::get<Frame>(drive.load(i)), {.held_out = i == held_out})));
  }
  return records;
}

/// The street with navigation that is 10 % too slow: 0.56 m off at frame 7.
inline SyntheticDrive street_with_slow_navigation() {
  SyntheticDrive drive(street_scene(), 8, 0.8);
  std::vector<StampedPose> wrong;
  for (int i = 0; i < 8; ++i) {
    RigidMotion T = drive.T_local_lidar[std::size_t(i)];
    T.translation() *= 0.9;
    wrong.push_back({SyntheticDrive::stamp_of(i), T});
  }
  drive.editable_info().navigation = Trajectory(wrong);
  return drive;
}

inline const SyntheticDrive& street() {
  static const SyntheticDrive drive(street_scene(), 8, 0.8);
  return drive;
}

/// Bit for bit, all columns.
inline void expect_same_maps(const TileMap& a, const TileMap& b) {
  ASSERT_EQ(a.submaps().size(), b.submaps().size());
  for (std::size_t id = 0; id < a.submaps().size(); ++id) {
    const Submap &left = a.submaps()[id], &right = b.submaps()[id];
    EXPECT_EQ(left.T_local_submap.matrix(), right.T_local_submap.matrix());
    ASSERT_EQ(left.tiles.size(), right.tiles.size());
    for (const auto& [key, stored] : left.tiles) {
      const PointCloud tile = stored.points->cloud();
      ASSERT_TRUE(right.tiles.contains(key));
      expect_same_columns(tile, right.tiles.at(key).points->cloud());
    }
  }
}

}  // namespace fovea
