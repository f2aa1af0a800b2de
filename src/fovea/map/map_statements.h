// The prepared statements of a map's writer. Private to map/.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "fovea/core/sqlite_database.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/tile_query.h"

namespace fovea {

/// Of one connection.
class MapStatements {
 public:
  explicit MapStatements(sqlite::Database& database)
      : no_tile(database, fmt::format("DELETE FROM tiles WHERE {}", kThisTile)),
        no_views(database, "DELETE FROM views WHERE frame = ?1"),
        frame(database, fmt::format("{} WHERE frame = ?1", select_sql(kFramesTable))),
        read_tile(database, current_format()) {
    for (const Table* table : kTables) inserts_.emplace_back(database, insert_sql(*table));
  }

  sqlite::Statement& insert(const Table& table) {
    const auto place = std::find(kTables.begin(), kTables.end(), &table) - kTables.begin();
    return inserts_.at(static_cast<std::size_t>(place));
  }
  sqlite::Statement no_tile, no_views, frame;
  TileQuery read_tile;

 private:
  std::vector<sqlite::Statement> inserts_;
};

}  // namespace fovea
