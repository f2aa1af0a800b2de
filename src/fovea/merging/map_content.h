// What merging needs of two maps besides their points. Private to merging/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/map/map_meta.h"

namespace fovea {

/// A map without its points.
struct MapContent {
  MapContent() = default;  // without frames
  /// @param with_digest  the drive of a map that is not merged gets the map's digest, which merged
  ///                     maps state. Otherwise it gets its identity, which takes no time.
  explicit MapContent(const MapReader& map, bool with_digest = false);

  /// Of a key of the meta data; empty without it.
  std::string text(const std::string& key) const;
  int end_frame() const { return drives.back().end_frame; }

  MapMeta meta;
  std::vector<FrameRecord> frames;
  std::vector<RigidMotion> T_local_submap;
  std::vector<MergedDrive> drives;   ///< one at least
  std::vector<DriveRecord> records;  ///< of these drives, as they are in a merged map
  std::vector<SensorRecord> sensors;
  double tile_size = 0;    ///< m
  bool is_merged = false;  ///< made by fovea merge or fovea fuse
};

/// InputError for a map that fovea merge or fovea fuse has made: its drives have odometry of their
/// own.
void require_one_drive(const MapContent& map, const std::string& where);

/// How the local frames lie to each other by a drive that both maps have, or else by their
/// georeferences; nothing if neither tells.
std::optional<RigidMotion> stated_T_a_b(const MapContent& a, const MapContent& b);

/// The cameras of all maps, as a map's meta data name them: "2,3".
std::string cameras_of(const std::vector<const MapContent*>& maps);

/// The drive that came from a map of this digest, or nullptr.
const MergedDrive* find_drive(const MapContent& map, const std::string& digest);

/// A drive of B that A does not have, and what becomes of it.
struct AddedDrive {
  MergedDrive in_b, merged;
  DriveRecord record;           ///< in the merged map
  std::size_t number_in_b = 0;  ///< of the drive
  std::size_t number = 0;       ///< of the drive in the merged map

  /// The number of a frame of B in the merged map; -1 for a frame of another drive, which a damaged
  /// map may name.
  int number_of(int frame_in_b) const {
    if (frame_in_b < in_b.first_frame || frame_in_b >= in_b.end_frame) return -1;
    return merged.first_frame + (frame_in_b - in_b.first_frame);
  }
};

/// InputError if the frames of both maps are too many.
std::vector<AddedDrive> drives_to_add(const MapContent& a, const MapContent& b);

/// Position of the middle frame of each submap in local; nothing for a submap without frames.
std::vector<std::optional<Eigen::Vector3d>> submap_middles(const std::vector<FrameRecord>& frames,
                                                           std::size_t submaps);

}  // namespace fovea
