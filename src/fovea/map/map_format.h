// What differs between the versions of the file that can be read. Private to map/.
#pragma once

#include <string>
#include <vector>

#include "fovea/map/map_records.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/map_store.h"
#include "fovea/map/tile_codec.h"

namespace fovea {

/// Queries of all versions give the columns of map_schema.h under its names.
struct MapFormat {
  int version = 0;
  bool has_checksums = true;  ///< of all rows and their counts, not of tiles alone
  TileFormat tile;
  /// As select_sql().
  std::string (*select)(const Table& table) = nullptr;
  /// The meta data with the keys of meta_keys.h.
  MapMeta (*meta)(MapMeta stored) = nullptr;
  /// The drives; absent: those of the table `drives`.
  /// @param stored  the meta data as they are in the file
  std::vector<DriveRecord> (*drives)(const MapMeta& stored) = nullptr;
  /// The drive of each submap; absent: as stored.
  std::vector<int> (*submap_drives)(const MapMeta& stored, std::size_t submaps) = nullptr;
};

/// Of the version that this program writes.
const MapFormat& current_format();
/// Of a version; nullptr if this program cannot read it.
const MapFormat* find_format(std::int64_t version);

}  // namespace fovea
