#include "fovea/map/map_file.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <utility>
#include <vector>

#include "fovea/core/file_format.h"
#include "fovea/core/input_file.h"
#include "fovea/core/path_remedy.h"
#include "fovea/map/map_opening.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/row_scan.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
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

/// Whether the table `meta` states the present version, with its checksum.
bool has_whole_version(sqlite::Database& database) try {
  Statement row(database, fmt::format("{} WHERE key = '{}'", select_sql(kMetaTable),
                                      meta_key::kFormatVersion));
  if (!row.step()) return false;
  const StoredRow stored = stored_row(row, kMetaTable);
  return stored.checksum == row_checksum(kMetaTable, stored.row);
} catch (const sqlite::CorruptFile&) {
  return false;
}

const MapFormat& format_of(sqlite::Database& database) {
  if (database.integer("PRAGMA application_id") != kMapApplicationId) {
    if (has_whole_version(database)) {
      throw sqlite::CorruptFile("the header names another program", database.where(), kRestoreMap);
    }
    throw InputError("an SQLite file, but not a Fovea map", database.where(),
                     "give a file that 'fovea map' wrote");
  }
  const std::int64_t version = database.integer("PRAGMA user_version");
  constexpr std::int64_t kImpossibleVersion = 1000;
  if (version < 0 || version >= kImpossibleVersion) {
    throw sqlite::CorruptFile(fmt::format("the header states the format version {}", version),
                              database.where(), kRestoreMap);
  }
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
    : path_(path), on_damage_(std::move(on_damage)) {
  require_file(path_);
  // With a log, the present header may lie there.
  const bool is_one_file = !has_log(path_);
  const bool has_whole_header = !is_one_file || !has_damaged_header(path_);
  if (const auto missing = missing_bytes(path_); missing && is_one_file && has_whole_header) {
    read([&] { throw InputError("the map is cut short: " + *missing, where(), kRestoreMap); });
  }
  try {
    if (!has_whole_header) throw sqlite::CorruptFile("impossible header", where(), kRestoreMap);
    open();
  } catch (const sqlite::NoDatabase& error) {
    open_with_new_first_page(error);
  } catch (const sqlite::CorruptFile& error) {
    open_with_new_first_page(error);
  }
}

void MapFile::open() {
  sqlite_ = open_for_reading(copy_ ? copy_->path() : path_, path_);
  // Only with this does SQLite open a file that is shorter than it should be.
  if (on_damage_) sqlite_->attempt("PRAGMA writable_schema=ON");
  format_ = &format_of(*sqlite_);
  for (const Table* table : kTables) {
    query(*table, [&] { Statement(*sqlite_, format_->select(*table) + " LIMIT 0"); });
  }
}

/// Called while `error` is handled.
void MapFile::open_with_new_first_page(const InputError& error) {
  const bool is_older = format_ != nullptr && format_ != &current_format();
  if (is_older || !has_pages_of_map(path_)) throw;
  read([&] {
    throw InputError(fmt::format("the first page, with header and list of tables, is damaged ({})",
                                 error.problem()),
                     where(), kRestoreMap);
  });
  copy_ = std::make_unique<CopyWithNewFirstPage>(path_);
  open();
}

sqlite::CorruptFile MapFile::damage(const std::string& problem, const Table& table) const {
  return {problem, fmt::format("{}, table '{}'", where(), table.name), kRestoreMap};
}

void MapFile::check_structure() {
  if (copy_) return;  // its free pages are not those of the map
  const std::vector<std::string> all = sqlite::find_faults(*sqlite_);
  if (all.empty()) return;
  std::set<std::string> named;
  for (const Table* table : kTables) {
    for (const std::string& fault : sqlite::find_faults(*sqlite_, table->name)) {
      named.insert(fault);
      read([&] { throw damage("the structure is damaged (" + fault + ")", *table); });
    }
  }
  for (const std::string& fault : all) {
    if (named.contains(fault)) continue;
    read([&] {
      throw InputError("the structure is damaged (" + fault + ")", where(), kRestoreMap);
    });
  }
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
  if (on_damage_ && format_->has_checksums) return for_each_readable_row(table, f);
  std::int64_t count = 0;
  read([&] {
    Statement rows = query(table, [&] {
      return Statement(*sqlite_, fmt::format("{} ORDER BY {}", format_->select(table), table.key));
    });
    while (query(table, [&] { return rows.step(); })) {
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

void MapFile::for_each_readable_row(const Table& table, const std::function<void(const Row&)>& f) {
  std::set<std::uint64_t> seen;
  std::int64_t count = 0;
  RowLimit limit(path_, table);
  read([&] {
    scan_rows(
        *sqlite_, table, format_->select(table),
        [&](const Statement& found) {
          limit.count();
          const StoredRow stored = stored_row(found, table);
          if (stored.checksum && !seen.insert(*stored.checksum).second) return;
          ++count;
          read([&] {
            require_whole(table, stored, where());
            f(stored.row);
          });
        },
        [&](const std::string& problem) { read([&] { throw damage(problem, table); }); });
  });
  read([&] { require_count(table, count); });
}

std::optional<Row> MapFile::find_row(const Table& table, const std::string& first) {
  Statement rows = query(table, [&] {
    return Statement(
        *sqlite_, fmt::format("{} WHERE {} = ?1", format_->select(table), table.columns[0].name));
  });
  rows.bind(1, std::string_view(first));
  if (!query(table, [&] { return rows.step(); })) return std::nullopt;
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
  if (on_damage_) return for_each_readable_tile(f);
  Statement rows = query(kTilesTable, [&] {
    return Statement(*sqlite_,
                     fmt::format("{} ORDER BY {}", format_->select(kTilesTable), kTilesTable.key));
  });
  std::int64_t count = 0;
  while (query(kTilesTable, [&] { return rows.step(); })) {
    ++count;
    f(tile_row(rows, where()));
  }
  require_count(kTilesTable, count);
}

void MapFile::for_each_readable_tile(const std::function<void(const TileRow&)>& f) {
  std::set<std::array<std::int64_t, 4>> found;
  const auto key_of = [](const Statement& row) {
    return std::array{row.integer(0), row.integer(1), row.integer(2), row.integer(3)};
  };
  RowLimit limit(path_, kTilesTable);
  read([&] {
    scan_rows(
        *sqlite_, kTilesTable, format_->select(kTilesTable),
        [&](const Statement& row) {
          limit.count();
          if (found.insert(key_of(row)).second) read([&] { f(tile_row(row, where())); });
        },
        [&](const std::string& problem) { read([&] { throw damage(problem, kTilesTable); }); });
  });
  // The index names the tiles on pages that cannot be read.
  read([&] {
    Statement keys(*sqlite_, "SELECT submap, x, y, z FROM tiles ORDER BY submap, x, y, z");
    while (query(kTilesTable, [&] { return keys.step(); })) {
      const auto key = key_of(keys);
      if (found.contains(key)) continue;
      read([&] {
        throw InputError(
            "a tile cannot be read",
            fmt::format("{}, tile {} {} {} of submap {}", where(), key[1], key[2], key[3], key[0]),
            kRestoreMap);
      });
    }
  });
  read([&] { require_count(kTilesTable, static_cast<std::int64_t>(found.size())); });
}

}  // namespace fovea
