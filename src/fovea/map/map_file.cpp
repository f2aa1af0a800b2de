#include "fovea/map/map_file.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <utility>
#include <vector>

#include "fovea/base/file_format.h"
#include "fovea/base/input_file.h"
#include "fovea/base/path_remedy.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using sqlite::Access;
using sqlite::Statement;

constexpr const char* kGiveMap = "give a map that 'fovea map' wrote";

void require_file(const fs::path& path) {
  std::error_code error, ignored;
  const fs::file_status status = fs::status(path, error);
  if (error && error.value() != ENOENT && error.value() != ENOTDIR) {
    throw InputError(fmt::format("the map cannot be read ({})", error.message()), path.string(),
                     path_remedy(error.value(), "check its permissions and its disk"));
  }
  if (!fs::exists(status)) {
    throw InputError("the map does not exist", path.string(), "check the name");
  }
  const InputFile file(path, kStreamedFile);
  if (file.size() == 0) throw InputError("the file is empty", path.string(), kGiveMap);
  const SniffedFormat found = sniff_format(file.beginning(kSniffedBytes));
  if (found.format != FileFormat::kSqlite && found.format != FileFormat::kUnknown) {
    throw InputError(fmt::format("this is {}, not a Fovea map", found.name), path.string(),
                     kGiveMap);
  }
}

/// A map whose log is empty can be read without side files: from a read-only folder, say.
bool has_log(const fs::path& path) {
  std::error_code ignored;
  for (const char* ending : {"-wal", "-journal"}) {
    const fs::path side = fs::path(path) += ending;
    if (fs::exists(side, ignored) && fs::file_size(side, ignored) > 0) return true;
  }
  return false;
}

std::unique_ptr<sqlite::Database> open_for_reading(const fs::path& path) {
  require_file(path);
  auto database = std::make_unique<sqlite::Database>(path, Access::kRead, path);
  // SQLite reads nothing before the first statement.
  constexpr const char* kFirstStatement = "SELECT count(*) FROM sqlite_master";
  if (database->attempt(kFirstStatement) != sqlite::Outcome::kFailed) return database;
  if (!has_log(path)) {
    return std::make_unique<sqlite::Database>(path, Access::kReadImmutable, path);
  }
  // A program was killed while it changed how the file is journalled. A connection that may write
  // repairs that; then the file can be read.
  sqlite::Database(path, Access::kWrite, path).attempt(kFirstStatement);
  return std::make_unique<sqlite::Database>(path, Access::kRead, path);
}

const MapFormat& format_of(sqlite::Database& database) {
  if (database.integer("PRAGMA application_id") != kMapApplicationId) {
    throw InputError("an SQLite file, but not a Fovea map", database.where(),
                     "give a file that 'fovea map' wrote");
  }
  const std::int64_t version = database.integer("PRAGMA user_version");
  const MapFormat* format = find_format(version);
  if (format == nullptr) {
    throw InputError(fmt::format("the map has format version {}, this program reads {} and {}",
                                 version, kMapFormatVersion - 1, kMapFormatVersion),
                     database.where(),
                     version > kMapFormatVersion
                         ? "use a newer Fovea"
                         : "map the drive again (fovea map DRIVE -o MAP --force)");
  }
  return *format;
}

}  // namespace

MapFile::MapFile(const fs::path& path, std::function<void(const std::string&)> on_damage)
    : sqlite_(open_for_reading(path)), on_damage_(std::move(on_damage)) {
  // Only with this does SQLite open a file that is shorter than it should be.
  if (on_damage_) sqlite_->attempt("PRAGMA writable_schema=ON");
  format_ = &format_of(*sqlite_);
}

TileQuery& MapFile::tile() {
  if (!tile_query_) tile_query_.emplace(*sqlite_, *format_);
  return *tile_query_;
}

void MapFile::require_count(const Table& table, std::int64_t rows) {
  if (!format_->has_checksums || &table == &kCountsTable) return;
  const std::optional<Row> count = find_row(kCountsTable, table.name);
  if (!count) {
    throw InputError("the number of a table's rows is missing",
                     fmt::format("{}, table '{}'", where(), table.name), kRestoreMap);
  }
  RowCursor cursor(kCountsTable, *count, where());
  cursor.text();
  const std::int64_t expected = cursor.integer();
  if (expected == rows) return;
  throw InputError(fmt::format("a table has {} rows in place of {}", rows, expected),
                   fmt::format("{}, table '{}'", where(), table.name), kRestoreMap);
}

void MapFile::for_each_row(const Table& table, const std::function<void(const Row&)>& f) {
  const Snapshot snapshot(*sqlite_);
  std::int64_t count = 0;
  read([&] {
    Statement rows(*sqlite_, fmt::format("{} ORDER BY {}", format_->select(table), table.key));
    while (rows.step()) {
      ++count;
      read([&] {
        const StoredRow stored = stored_row(rows, table);
        if (format_->has_checksums) require_whole(table, stored, where());
        f(stored.row);
      });
    }
  });
  read([&] { require_count(table, count); });
}

std::optional<Row> MapFile::find_row(const Table& table, const std::string& first) {
  Statement rows(*sqlite_,
                 fmt::format("{} WHERE {} = ?1", format_->select(table), table.columns[0].name));
  rows.bind(1, std::string_view(first));
  if (!rows.step()) return std::nullopt;
  StoredRow stored = stored_row(rows, table);
  if (format_->has_checksums) require_whole(table, stored, where());
  for (Cell& cell : stored.row) {
    if (const auto* blob = std::get_if<std::span<const std::byte>>(&cell)) {
      found_blob_.assign(blob->begin(), blob->end());
      cell = std::span<const std::byte>(found_blob_);
    }
  }
  return std::move(stored.row);
}

void MapFile::for_each_tile_row(const std::function<void(const TileRow&)>& f) {
  if (on_damage_) return for_each_whole_tile(f);
  Statement rows(*sqlite_,
                 fmt::format("{} ORDER BY {}", format_->select(kTilesTable), kTilesTable.key));
  std::int64_t count = 0;
  while (rows.step()) {
    ++count;
    f(tile_row(rows, where()));
  }
  require_count(kTilesTable, count);
}

void MapFile::for_each_whole_tile(const std::function<void(const TileRow&)>& f) {
  // First the keys, which stand apart: one row that cannot be read ends a query.
  std::vector<std::array<std::int64_t, 4>> keys;
  read([&] {
    Statement rows(*sqlite_, "SELECT submap, x, y, z FROM tiles ORDER BY submap, x, y, z");
    while (rows.step()) {
      keys.push_back({rows.integer(0), rows.integer(1), rows.integer(2), rows.integer(3)});
    }
  });
  for (const auto& key : keys) {
    read([&] {
      Statement row(*sqlite_, fmt::format("{} WHERE {}", format_->select(kTilesTable), kThisTile));
      for (int i = 0; i < 4; ++i) row.bind(i + 1, key[std::size_t(i)]);
      bool is_there = false;
      try {
        is_there = row.step();
      } catch (const InputError&) {
        // Named below: SQLite's message names the file alone.
      }
      if (!is_there) {
        throw InputError(
            "a tile cannot be read",
            fmt::format("{}, tile {} {} {} of submap {}", where(), key[1], key[2], key[3], key[0]),
            kRestoreMap);
      }
      f(tile_row(row, where()));
    });
  }
  read([&] { require_count(kTilesTable, static_cast<std::int64_t>(keys.size())); });
}

}  // namespace fovea
