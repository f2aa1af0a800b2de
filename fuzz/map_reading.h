// All ways to read a map file.
#pragma once

#include <filesystem>

#include "fovea/map/map_meta.h"
#include "fovea/map/map_store.h"
#include "fuzz_input.h"

namespace fovea {

inline void check_frames(const std::vector<FrameRecord>& frames) {
  for (const FrameRecord& frame : frames) {
    require(frame.T_local_lidar.matrix().allFinite(), "poses are finite");
  }
}

inline void check_order(const MapReader& map) {
  const std::vector<FrameRecord> frames = map.frames();
  for (std::size_t i = 1; i < frames.size(); ++i) {
    require(frames[i - 1].index < frames[i].index, "frames are in order");
  }
  const auto tiles = map.tile_sizes();
  for (std::size_t i = 1; i < tiles.size(); ++i) {
    require(tiles[i - 1].first < tiles[i].first, "tiles are in order");
  }
  // As a run that is resumed takes them over.
  TileMap in_memory;
  for (const RigidMotion& T_local_submap : map.submaps()) in_memory.add_submap(T_local_submap);
  for (const auto& [id, points] : tiles) {
    in_memory.declare_stored(id, points);
    read_or_refuse([&] { map.read_tile(id).check(); });
  }
}

inline void ask_all(const MapReader& map) {
  read_or_refuse([&] {
    const MapMeta meta = map.meta();
    map_origin(meta);
    read_or_refuse([&] { map_tile_size(meta); });
  });
  read_or_refuse([&] { merged_drives(map); });
  read_or_refuse([&] { map.sensors(); });
  read_or_refuse([&] { map.submap_records(); });
  read_or_refuse([&] {
    map.for_each_keyframe([](const KeyframeRecord& keyframe) {
      require(keyframe.ranges.size() == keyframe.elevations.size() * keyframe.columns,
              "a range image has all its pixels");
    });
  });
  read_or_refuse([&] { map.checkpoint("tracker"); });
  read_or_refuse([&] { map.check(); });
  read_or_refuse([&] { check_frames(map.frames()); });
  read_or_refuse([&] { map.submaps(); });
  read_or_refuse([&] { map.size(); });
  read_or_refuse([&] { map.colored_size(); });
  read_or_refuse([&] { map.tile_sizes(); });
  read_or_refuse([&] {
    map.for_each_tile([](std::size_t, const TileKey&, const PointCloud& tile) { tile.check(); });
  });
  read_or_refuse([&] { map.all_points_local().check(); });
  read_or_refuse([&] { require(map.digest().size() == 32, "a digest has 32 digits"); });
}

/// Opens it as `fovea map --resume` does, reads its tiles and writes them again.
inline void go_on_with_map(const std::filesystem::path& path) {
  read_or_refuse<Error>([&] {
    const auto tiles = MapReader(path).tile_sizes();
    const auto map = MapWriter::open(path);
    for (const auto& [id, size] : tiles) map->put_tile(id, map->read_tile(id));
    map->commit();
  });
}

/// Uses a file in one of the ways in which the program does; all of them at once would be a third
/// as many inputs.
/// @param way  any number
inline void use_map(const std::filesystem::path& path, unsigned way) {
  switch (way % 3) {
    case 0:
      read_or_refuse([&] {
        const MapReader map(path);
        ask_all(map);
        check_order(map);
      });
      break;
    case 1:
      read_or_refuse([&] {
        ask_all(MapReader(path, [](const std::string& damage) {
          require(!damage.empty(), "damage is told of in words");
        }));
      });
      break;
    default:
      go_on_with_map(path);
  }
}

}  // namespace fovea
