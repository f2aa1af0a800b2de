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

/// Removes the log and journal files next to a map.
void remove_side_files(const std::filesystem::path& map);

/// For a map that a new one replaces: merges its log, which otherwise SQLite would take for the new
/// map's log after the rename. Files that are no map stay as they are. OutputError if a program
/// uses the map.
void merge_old_map(const std::filesystem::path& map);

/// merge_old_map(), and removes the logs of a map that no longer exists.
void remove_old_map_logs(const std::filesystem::path& map);

}  // namespace fovea
