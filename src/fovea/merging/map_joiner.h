// Puts two maps into one file. Private to merging/.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "fovea/map/tile_map.h"
#include "fovea/mapping/radiometry.h"
#include "fovea/merging/alignment.h"
#include "fovea/merging/map_content.h"
#include "fovea/merging/tile_output.h"

namespace fovea {

/// What becomes of the numbers of B's drives and sensors in the merged map.
class Renumbering {
 public:
  Renumbering(const MapContent& a, const MapContent& b, const std::vector<AddedDrive>& added);

  int drive_of(int in_b) const;
  int sensor_of(int in_b) const;
  /// Renumbers the columns of a tile of B.
  void apply(TilePoints& tile) const;

  /// The sensors of the drives that are added, by their numbers in the merged map.
  const std::vector<std::pair<std::size_t, SensorRecord>>& sensors() const { return sensors_; }

 private:
  std::vector<int> drives_, sensor_numbers_;  // by the numbers in B
  std::vector<std::pair<std::size_t, SensorRecord>> sensors_;
};

/// Puts both maps into one file, as they are, and declares their tiles in `map`.
class MapJoiner {
 public:
  MapJoiner(const MapReader& a, const MapReader& b, MapWriter& output, TileMap& map)
      : a_(a), b_(b), output_(output), map_(map), tiles_(output) {}

  void copy_a(const MapContent& content);
  /// @param gain  of B, see gain_of_maps()
  void add_b(const MapContent& content, const std::vector<AddedDrive>& drives,
             const Renumbering& renumbering, const MapAlignment& alignment,
             const RigidMotion& stated_T_a_b, const LogGain& gain);

 private:
  void put(const TileId& id, TilePoints tile);
  void add_submap(const RigidMotion& T_local_submap, const AddedDrive& drive);
  void add_frames(const MapContent& content, const AddedDrive& drive, const MapAlignment& alignment,
                  const RigidMotion& stated_T_a_b, const LogGain& gain);
  void add_keyframes(const std::vector<AddedDrive>& drives, const Renumbering& renumbering);

  const MapReader& a_;
  const MapReader& b_;
  MapWriter& output_;
  TileMap& map_;
  TileOutput tiles_;
};

/// Puts the drives and sensors of both maps.
void put_drives(const MapContent& a, const std::vector<AddedDrive>& added,
                const Renumbering& renumbering, const RigidMotion& stated_T_a_b, MapWriter& output);

}  // namespace fovea
