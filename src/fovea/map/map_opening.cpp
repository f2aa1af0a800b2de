#include "fovea/map/map_opening.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using sqlite::Access;

/// No user may write the file, so it does not change. SQLite needs no locks, which shared folders
/// often lack.
bool is_read_only(const fs::path& path) {
  constexpr auto kMayWrite =
      fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return !error && (status.permissions() & kMayWrite) == fs::perms::none;
}

}  // namespace

bool has_log(const fs::path& path) {
  std::error_code ignored;
  for (const char* ending : {"-wal", "-journal"}) {
    const fs::path side = fs::path(path) += ending;
    if (fs::exists(side, ignored) && fs::file_size(side, ignored) > 0) return true;
  }
  return false;
}

std::unique_ptr<sqlite::Database> open_for_reading(const fs::path& path,
                                                   const fs::path& shown_path) {
  if (is_read_only(path) && !has_log(path)) {
    return std::make_unique<sqlite::Database>(path, Access::kReadImmutable, shown_path);
  }
  auto database = std::make_unique<sqlite::Database>(path, Access::kRead, shown_path);
  // SQLite reads nothing before the first statement.
  constexpr const char* kFirstStatement = "SELECT count(*) FROM sqlite_master";
  if (database->attempt(kFirstStatement) != sqlite::Outcome::kFailed) return database;
  // A map whose log is empty can be read without side files: from a read-only folder, say.
  if (!has_log(path)) {
    return std::make_unique<sqlite::Database>(path, Access::kReadImmutable, shown_path);
  }
  // A program was killed while it changed how the file is journalled. A connection that may write
  // repairs that; then the file can be read.
  sqlite::Database(path, Access::kWrite, shown_path).attempt(kFirstStatement);
  return std::make_unique<sqlite::Database>(path, Access::kRead, shown_path);
}

}  // namespace fovea
