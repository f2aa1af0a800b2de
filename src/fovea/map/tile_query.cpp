#include "fovea/map/tile_query.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "fovea/errors.h"
#include "fovea/geometry/position_limit.h"
#include "fovea/map/map_store.h"

namespace fovea {

TileKey tile_key(const sqlite::Statement& statement, int column, const std::string& map_path) {
  const auto number = [&](int at) {
    const std::int64_t value = statement.integer(at);
    if (!std::in_range<std::int32_t>(value)) {
      throw InputError(fmt::format("a tile has the impossible key {}", value), map_path,
                       kRestoreMap);
    }
    return static_cast<std::int32_t>(value);
  };
  return {number(column), number(column + 1), number(column + 2)};
}

TileRow tile_row(const sqlite::Statement& statement, const std::string& map_path) {
  TileRow row;
  row.submap = statement.integer(0);
  row.key = tile_key(statement, 1, map_path);
  row.points = statement.integer(4);
  row.colored = statement.integer(5);
  row.origin = {statement.real(6), statement.real(7), statement.real(8)};
  if (!is_possible_position(row.origin)) {
    throw InputError("a tile has an impossible origin", map_path, kRestoreMap);
  }
  constexpr auto kFirst = static_cast<int>(kFirstPointColumn);
  constexpr auto kCount = static_cast<int>(kStoredColumns);
  for (int i = 0; i < kCount; ++i) row.blobs[std::size_t(i)] = statement.blob(kFirst + i);
  row.checksum = static_cast<std::uint64_t>(statement.integer(kFirst + kCount));
  return row;
}

void bind_tile(sqlite::Statement& statement, const TileId& id) {
  int parameter = 0;
  for (const std::int64_t number : {static_cast<std::int64_t>(id.submap), std::int64_t{id.key.x},
                                    std::int64_t{id.key.y}, std::int64_t{id.key.z}}) {
    statement.bind(++parameter, number);
  }
}

TileQuery::TileQuery(sqlite::Database& database, const MapFormat& format)
    : row_(database, fmt::format("{} WHERE {}", format.select(kTilesTable), kThisTile)),
      decoder_(format.tile) {}

std::optional<TilePoints> TileQuery::find(const TileId& id, const std::string& map_path) {
  bind_tile(row_, id);
  // However this ends, the next tile can be asked for.
  const std::unique_ptr<sqlite::Statement, void (*)(sqlite::Statement*)> ready(
      &row_, [](sqlite::Statement* row) { row->reset(); });
  try {
    if (!row_.step()) return std::nullopt;
  } catch (const sqlite::CorruptFile& error) {
    throw InputError(error.problem(),
                     fmt::format("{}, tile {} {} {} of submap {}", map_path, id.key.x, id.key.y,
                                 id.key.z, id.submap),
                     kRestoreMap);
  }
  return decoder_.decode(tile_row(row_, map_path), map_path);
}

TilePoints TileQuery::read(const TileId& id, const std::string& map_path) {
  if (std::optional<TilePoints> tile = find(id, map_path)) return std::move(*tile);
  throw InputError(
      fmt::format("tile {} {} {} of submap {} is missing", id.key.x, id.key.y, id.key.z, id.submap),
      map_path, kRestoreMap);
}

}  // namespace fovea
