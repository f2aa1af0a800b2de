// The write-ahead log next to a map that is being written. Private to map/.
#pragma once

#include <chrono>
#include <filesystem>

#include "fovea/core/sqlite_database.h"

namespace fovea {

/// Merges the log into the file and removes it. While others have the map open, an empty log stays.
/// Waits for nothing. Best effort: SQLite reads the content of a log that stays.
void leave_one_file(sqlite::Database& database) noexcept;

/// leave_one_file() at the end of a map. OutputError if the file alone would not be the whole map.
/// @param reader_timeout  how long to wait for readers of earlier states
void merge_log(sqlite::Database& database, const std::filesystem::path& map,
               std::chrono::milliseconds reader_timeout);

}  // namespace fovea
