// A map file that is open for reading: its rows with their checksums and counts. Private to map/.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fovea/core/sqlite_database.h"
#include "fovea/errors.h"
#include "fovea/map/first_page.h"
#include "fovea/map/map_format.h"
#include "fovea/map/map_row.h"
#include "fovea/map/tile_query.h"

namespace fovea {

/// While it lives, all statements see one committed state; snapshots may nest.
class Snapshot {
 public:
  explicit Snapshot(sqlite::Database& database) : database_(database) {
    database_.execute("SAVEPOINT snapshot");
  }
  ~Snapshot() { database_.attempt("RELEASE snapshot"); }
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

 private:
  sqlite::Database& database_;
};

class MapFile {
 public:
  /// @param on_damage  takes a line about each row that cannot be read, which is then left out;
  ///                   absent: such a row is an InputError
  MapFile(const std::filesystem::path& path, std::function<void(const std::string&)> on_damage);

  /// InputError, or a report, of each fault that SQLite finds in pages, indexes and free pages.
  void check_structure();

  sqlite::Database& sqlite() { return *sqlite_; }
  const MapFormat& format() const { return *format_; }
  std::string where() const { return path_.string(); }
  bool reports_damage() const { return static_cast<bool>(on_damage_); }

  /// Runs a step of reading. If damage is reported, reports its InputError and returns false.
  template <class Step>
  bool read(Step&& step) {
    if (!on_damage_) {
      step();
      return true;
    }
    try {
      step();
      return true;
    } catch (const InputError& error) {
      const std::string damage = error.problem() + ", " + error.where();
      if (reported_.insert(damage).second) on_damage_(damage);
      return false;
    }
  }

  /// Runs a query of a table; an error of SQLite names the table then.
  template <class Step>
  auto query(const Table& table, Step&& step) const {
    try {
      return step();
    } catch (const sqlite::CorruptFile& error) {
      throw damage(error.problem(), table);
    }
  }

  /// Calls f(row) for each whole row of a table in the order of its key, and checks their number.
  void for_each_row(const Table& table, const std::function<void(const Row&)>& f);
  /// The row whose first column has this text; nothing if there is none. Its blob, one at most, is
  /// valid until the next call.
  std::optional<Row> find_row(const Table& table, const std::string& first);
  /// Calls f(row) for each tile in the order of its key, and checks their number.
  void for_each_tile_row(const std::function<void(const TileRow&)>& f);
  TileQuery& tile();
  /// InputError if the table `counts` has another number for a table.
  void require_count(const Table& table, std::int64_t rows);

 private:
  void open();
  void open_with_new_first_page(const InputError& error);
  void for_each_readable_row(const Table& table, const std::function<void(const Row&)>& f);
  void for_each_readable_tile(const std::function<void(const TileRow&)>& f);
  sqlite::CorruptFile damage(const std::string& problem, const Table& table) const;

  std::filesystem::path path_;
  std::unique_ptr<CopyWithNewFirstPage> copy_;  // if the first page is damaged
  std::unique_ptr<sqlite::Database> sqlite_;
  const MapFormat* format_ = nullptr;
  std::function<void(const std::string&)> on_damage_;
  std::set<std::string> reported_;       // a row may be read several times
  std::optional<TileQuery> tile_query_;  // once it is needed
  std::vector<std::byte> found_blob_;    // of the latest find_row()
};

}  // namespace fovea
