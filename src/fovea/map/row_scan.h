// Reads the rows of a table whose pages may be damaged. Private to map/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "fovea/core/sqlite_database.h"
#include "fovea/map/map_schema.h"

namespace fovea {

/// Ends the reading of a table whose pages refer to the same pages again and again.
class RowLimit {
 public:
  RowLimit(const std::filesystem::path& map, const Table& table);
  /// Counts a row. InputError if the file cannot hold that number of rows.
  void count();

 private:
  std::string map_;
  const Table& table_;
  std::uintmax_t left_;
};

/// Calls row(statement) for each row of a table that can be reached. Rows may come twice and in any
/// order. Rows behind a damaged page are found by their numbers, rows of tables with text keys from
/// both ends and by the known keys.
/// @param damage  takes "rows from frame 3 to 9 cannot be read" for each gap
/// @param select  query of all rows, as select_sql()
void scan_rows(sqlite::Database& database, const Table& table, const std::string& select,
               const std::function<void(const sqlite::Statement&)>& row,
               const std::function<void(const std::string& problem)>& damage);

}  // namespace fovea
