#include "fovea/map/map_log.h"

#include <fmt/format.h>

#include "fovea/errors.h"
#include "fovea/map/map_store.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using sqlite::Access;
using sqlite::Database;
using sqlite::Outcome;

bool has_side_files(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::path(path) += "-wal", ignored);
}

}  // namespace

void leave_one_file(Database& database) noexcept {
  database.attempt("PRAGMA busy_timeout=0");
  if (database.attempt("PRAGMA journal_mode=DELETE") == Outcome::kDone) return;
  database.attempt("PRAGMA wal_checkpoint(TRUNCATE)");
}

void merge_log(Database& database, const fs::path& map, std::chrono::milliseconds reader_timeout) {
  const Outcome outcome = database.merge_log(reader_timeout);
  if (outcome == Outcome::kDone) return leave_one_file(database);
  const std::string reason = outcome == Outcome::kBusy
                                 ? "another program keeps an earlier state of the map open"
                                 : database.reason();
  throw OutputError(
      fmt::format("the end of the map is only in its log, not in the map ({})", reason),
      fs::path(map).concat("-wal").string(), log_remedy(map));
}

void fold_log(const fs::path& path) {
  std::error_code ignored;
  const fs::path file = fs::canonical(path, ignored);
  if (ignored || !has_side_files(file)) return;
  try {
    {
      const MapReader is_a_map(file);
    }
    // Fails at once while another program has the map open.
    Database(file, Access::kWrite, path)
        .attempt("PRAGMA busy_timeout=0; PRAGMA journal_mode=DELETE");
  } catch (const Error&) {
    // No map, or one that cannot be written: reading it reports what is wrong.
  }
}

fs::path log_of_map(const fs::path& path) {
  std::error_code ignored;
  const fs::path file = fs::canonical(path, ignored);
  if (ignored) return {};
  const fs::path log = fs::path(file).concat("-wal");
  const std::uintmax_t size = fs::file_size(log, ignored);
  return ignored || size == 0 ? fs::path() : log;
}

std::string log_remedy(const fs::path& map) {
  std::error_code ignored;
  const fs::path file = fs::canonical(map, ignored);
  return fmt::format(
      "keep {} next to the map, it is part of it; free disk space or close the programs that have "
      "the map open, then 'fovea info {}' merges it",
      fs::path(file).concat("-wal").string(), file.string());
}

void remove_side_files(const fs::path& map) {
  for (const char* ending : {"-wal", "-shm", "-journal"}) {
    std::error_code ignored;
    fs::remove(fs::path(map) += ending, ignored);
  }
}

void merge_old_map(const fs::path& map) {
  if (!fs::exists(map)) return;
  Database old(map, Access::kWrite, map);
  if (old.attempt("PRAGMA journal_mode=DELETE") == Outcome::kBusy) old.throw_busy();
}

void remove_old_map_logs(const fs::path& map) {
  merge_old_map(map);
  remove_side_files(map);
}

}  // namespace fovea
