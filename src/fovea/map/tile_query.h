// Rows of the table `tiles`, as both the reader and the writer of a map see them. Private to map/.
#pragma once

#include <optional>
#include <string>

#include "fovea/core/sqlite_database.h"
#include "fovea/map/map_format.h"
#include "fovea/map/tile_codec.h"

namespace fovea {

/// The condition for one tile: submap, x, y, z are its first four parameters.
inline constexpr const char* kThisTile = "submap = ?1 AND x = ?2 AND y = ?3 AND z = ?4";

/// The present row of a query for all columns of the tiles; its blobs are valid until the next
/// step. InputError that names `map_path` if a number is impossible.
TileRow tile_row(const sqlite::Statement& statement, const std::string& map_path);

/// The key in three columns from `column` on; InputError as above.
TileKey tile_key(const sqlite::Statement& statement, int column, const std::string& map_path);

/// Binds the parameters of kThisTile.
void bind_tile(sqlite::Statement& statement, const TileId& id);

/// Reads one tile at a time.
class TileQuery {
 public:
  TileQuery(sqlite::Database& database, const MapFormat& format);
  /// Nothing if there is no such tile; InputError that names `map_path` if it is damaged.
  std::optional<TilePoints> find(const TileId& id, const std::string& map_path);
  /// InputError that names tile and `map_path` also if it is not there.
  TilePoints read(const TileId& id, const std::string& map_path);

 private:
  sqlite::Statement row_;
  TileDecoder decoder_;
};

}  // namespace fovea
