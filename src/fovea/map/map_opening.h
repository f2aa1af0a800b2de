// How the database of a map is opened for reading. Private to map/.
#pragma once

#include <filesystem>
#include <memory>

#include "fovea/core/sqlite_database.h"

namespace fovea {

/// Whether a log or a journal with content lies next to a map.
bool has_log(const std::filesystem::path& path);

/// A read-only map is read without locks, as is one in a folder where SQLite can make none.
/// @param shown_path  the map, of which `path` may be a copy
std::unique_ptr<sqlite::Database> open_for_reading(const std::filesystem::path& path,
                                                   const std::filesystem::path& shown_path);

}  // namespace fovea
