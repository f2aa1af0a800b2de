#include <fmt/format.h>

#include <mutex>
#include <stdexcept>

#include "fovea/base/errors.h"
#include "fovea/base/output_file.h"
#include "fovea/base/parallel.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/map_store.h"
#include "fovea/map/number_text.h"
#include "fovea/map/sqlite_database.h"
#include "fovea/map/tile_codec.h"
#include "fovea/map/tile_query.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using sqlite::Access;
using sqlite::Database;
using sqlite::Outcome;
using sqlite::Statement;

/// Larger than SQLite's default: a tile's columns are tens of kilobytes each.
constexpr int kPageSize = 8192;

void remove_side_files(const fs::path& path) {
  for (const char* ending : {"-wal", "-shm", "-journal"}) {
    std::error_code ignored;
    fs::remove(fs::path(path) += ending, ignored);
  }
}

bool has_side_files(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::path(path) += "-wal", ignored);
}

/// Folds everything into the one file. Best effort: what stays beside it is read by SQLite.
void leave_one_file(Database& database) noexcept { database.attempt("PRAGMA journal_mode=DELETE"); }

/// Makes the old map under this name one file, so that its write-ahead log cannot be taken for the
/// new map's after the rename; that of a map which was removed is left. OutputError if a program is
/// using it.
void settle_old_map(const fs::path& path) {
  if (fs::exists(path)) {
    Database old(path, Access::kWrite, path);
    // What fails otherwise is no map, and is replaced all the same.
    if (old.attempt("PRAGMA journal_mode=DELETE") == Outcome::kBusy) old.throw_busy();
  }
  remove_side_files(path);
}

/// The prepared statements of one connection.
struct Puts {
  explicit Puts(Database& database)
      : meta(database, "INSERT OR REPLACE INTO meta VALUES(?1, ?2)"),
        frame(database,
              "INSERT OR REPLACE INTO frames VALUES(?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13)"),
        submap(database, "INSERT OR REPLACE INTO submaps VALUES(?1, ?2)"),
        tile(database,
             "INSERT OR REPLACE INTO tiles VALUES"
             "(?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13,?14,?15,?16,?17,?18,?19,"
             "?20,?21,?22)"),
        pose(database, "UPDATE frames SET pose = ?2 WHERE idx = ?1"),
        no_tile(database, fmt::format("DELETE FROM tiles WHERE {}", kThisTile)),
        read_tile(database) {}
  Statement meta, frame, submap, tile, pose, no_tile;
  TileQuery read_tile;
};

void require_finite(bool finite, const std::string& what) {
  if (!finite) throw std::invalid_argument(fmt::format("{} is not finite", what));
}

class SqliteMapWriter : public MapWriter {
 public:
  /// A new map, which grows in PATH.partial until its first commit.
  SqliteMapWriter(const fs::path& path, bool force)
      : path_(path), target_(check_output_path(path, force)), force_(force) {
    start_partial_file();
  }

  /// An existing map.
  explicit SqliteMapWriter(const fs::path& path)
      : path_(path), target_(check_output_path(path, true)), force_(true), published_(true) {
    open_published_file();
  }

  ~SqliteMapWriter() override {
    puts_.reset();
    if (database_ != nullptr && published_) {
      database_->attempt("ROLLBACK");
      leave_one_file(*database_);
    }
    const bool drop = database_ != nullptr && !published_;
    database_.reset();
    if (drop) remove_partial_file();
  }

  void put_meta(const std::string& key, const std::string& value) override {
    if (key == kSchemaVersionKey) {
      throw std::invalid_argument(fmt::format("the meta key '{}' is the store's own", key));
    }
    write([&] { put_meta_row(key, value); });
  }

  void put_frame(const FrameRecord& record) override;
  void put_submap(std::size_t id, const RigidMotion& T_local_submap) override;
  void put_pose(int frame, const RigidMotion& T_local_lidar) override;
  void put_tile(const PackedTile& tile) override { put_row(encoder_.encode(tile)); }
  void put_tiles(std::size_t count, const std::function<PackedTile(std::size_t)>& tile) override;
  void remove_tile(const TileId& id) override;
  TilePoints read_tile(const TileId& id) override;

  void commit() override {
    write([&] {
      database_->execute("COMMIT");
      if (!published_) {
        publish();
      } else {
        // A reader may hold the log; then a later commit moves its pages.
        database_->attempt("PRAGMA wal_checkpoint(PASSIVE)");
        database_->execute("BEGIN IMMEDIATE");
      }
    });
  }

 private:
  /// Runs a step of writing; after a failure SQLite may have ended the transaction, so that a later
  /// step would be written on its own.
  template <class Step>
  void write(Step&& step) {
    if (failed_) throw std::logic_error("a map is written on after an error");
    failed_ = true;
    step();
    failed_ = false;
  }

  void put_row(const TileRow& row);
  void put_meta_row(std::string_view key, std::string_view value) {
    puts_->meta.bind(1, key);
    puts_->meta.bind(2, value);
    puts_->meta.run();
  }

  void start_partial_file();
  void remove_partial_file();
  void publish();
  void open_published_file();

  fs::path path_;    // as the user named it
  fs::path target_;  // the file itself, where path_ is a symbolic link
  bool force_;
  bool published_ = false;
  bool failed_ = false;
  TileEncoder encoder_;
  std::unique_ptr<Database> database_;
  std::unique_ptr<Puts> puts_;
};

void SqliteMapWriter::start_partial_file() {
  const fs::path partial = partial_path(target_);
  if (fs::exists(partial)) {
    // Left by a killed program, unless one still has its lock.
    Database left(partial, Access::kWrite, path_);
    if (left.attempt("BEGIN EXCLUSIVE") == Outcome::kBusy) left.throw_busy();
    fs::remove(partial);
  }
  remove_side_files(partial);
  database_ = std::make_unique<Database>(partial, Access::kCreate, path_);
  try {
    // A file that is thrown away on any failure needs no journal, and one sync when it is whole.
    database_->execute(
        fmt::format("PRAGMA page_size={}; PRAGMA locking_mode=EXCLUSIVE; PRAGMA journal_mode=OFF;"
                    "PRAGMA synchronous=OFF; PRAGMA application_id={}; PRAGMA user_version={};"
                    "BEGIN EXCLUSIVE;",
                    kPageSize, kMapApplicationId, kMapSchemaVersion)
            .c_str());
    database_->execute(kCreateTables);
    puts_ = std::make_unique<Puts>(*database_);
    put_meta_row(kSchemaVersionKey, fmt::format("{}", kMapSchemaVersion));
  } catch (...) {
    puts_.reset();
    database_.reset();
    remove_partial_file();
    throw;
  }
}

void SqliteMapWriter::remove_partial_file() {
  std::error_code ignored;
  fs::remove(partial_path(target_), ignored);
  remove_side_files(partial_path(target_));
}

void SqliteMapWriter::publish() {
  // Another program may have made the file meanwhile.
  check_output_path(path_, force_);
  settle_old_map(target_);
  publish_file(partial_path(target_), target_);
  published_ = true;
  puts_.reset();
  database_.reset();
  open_published_file();
}

void SqliteMapWriter::open_published_file() {
  database_ = std::make_unique<Database>(target_, Access::kWrite, path_);
  // Write-ahead log: others can read the map while it grows. The log is folded in after each
  // commit. Extra syncs come first: a rollback journal of the change to the log that reappears
  // after a power failure would undo commits.
  database_->execute(
      "PRAGMA synchronous=EXTRA; PRAGMA journal_mode=WAL; PRAGMA wal_autocheckpoint=0;");
  // The lock of one writer, held from commit to commit.
  database_->execute("BEGIN IMMEDIATE");
  puts_ = std::make_unique<Puts>(*database_);
}

void SqliteMapWriter::put_frame(const FrameRecord& record) {
  const std::string what = fmt::format("frame {}: a pose or velocity", record.index);
  require_finite(record.T_local_lidar.matrix().allFinite(), what);
  require_finite(record.T_odom_lidar.matrix().allFinite(), what);
  const std::string status = to_string(record.status);
  const std::string pose = format_pose(record.T_local_lidar);
  const std::string odom_pose = format_pose(record.T_odom_lidar);
  const std::string figures = to_json(record.figures);
  const std::string timings = to_json(record.milliseconds);
  std::string navigation, velocity, revisited;
  if (record.T_local_lidar_navigation) {
    require_finite(record.T_local_lidar_navigation->matrix().allFinite(), what);
    navigation = format_pose(*record.T_local_lidar_navigation);
  }
  if (record.motion) {
    require_finite(record.motion->velocity.allFinite(), what);
    require_finite(record.motion->acceleration.allFinite(), what);
    velocity = to_text(*record.motion);
  }
  if (record.revisit) {
    require_finite(record.revisit->T_submap_lidar.matrix().allFinite(), what);
    revisited = format_pose(record.revisit->T_submap_lidar);
  }
  write([&] {
    Statement& put = puts_->frame;
    const auto bind_or_null = [&](int parameter, const std::string& text) {
      text.empty() ? put.bind_null(parameter) : put.bind(parameter, std::string_view(text));
    };
    put.bind(1, std::int64_t{record.index});
    record.stamp ? put.bind(2, *record.stamp) : put.bind_null(2);
    put.bind(3, std::string_view(status));
    put.bind(4, std::string_view(record.note));
    put.bind(5, std::string_view(pose));
    bind_or_null(6, navigation);
    put.bind(7, std::string_view(odom_pose));
    put.bind(8, std::int64_t{record.submap});
    record.revisit ? put.bind(9, std::int64_t{record.revisit->submap}) : put.bind_null(9);
    bind_or_null(10, revisited);
    bind_or_null(11, velocity);
    put.bind(12, std::string_view(figures));
    put.bind(13, std::string_view(timings));
    put.run();
  });
}

void SqliteMapWriter::put_submap(std::size_t id, const RigidMotion& T_local_submap) {
  require_finite(T_local_submap.matrix().allFinite(), fmt::format("the pose of submap {}", id));
  const std::string pose = format_pose(T_local_submap);
  write([&] {
    puts_->submap.bind(1, static_cast<std::int64_t>(id));
    puts_->submap.bind(2, std::string_view(pose));
    puts_->submap.run();
  });
}

void SqliteMapWriter::put_pose(int frame, const RigidMotion& T_local_lidar) {
  require_finite(T_local_lidar.matrix().allFinite(), fmt::format("frame {}: a pose", frame));
  const std::string pose = format_pose(T_local_lidar);
  write([&] {
    puts_->pose.bind(1, std::int64_t{frame});
    puts_->pose.bind(2, std::string_view(pose));
    puts_->pose.run();
  });
}

void SqliteMapWriter::remove_tile(const TileId& id) {
  write([&] {
    bind_tile(puts_->no_tile, id);
    puts_->no_tile.run();
  });
}

TilePoints SqliteMapWriter::read_tile(const TileId& id) {
  TilePoints tile;
  write([&] { tile = puts_->read_tile.read(id, path_.string()); });
  return tile;
}

void SqliteMapWriter::put_tiles(std::size_t count,
                                const std::function<PackedTile(std::size_t)>& tile) {
  struct Encoded {
    TileEncoder encoder;
    TileRow row;  // its memory is the encoder's
  };
  // As many as are under way at a time, which are few.
  std::vector<std::unique_ptr<Encoded>> free;
  std::mutex guard;
  std::vector<std::unique_ptr<Encoded>> under_way(count);
  parallel_in_order(
      count,
      [&](std::size_t i) {
        std::unique_ptr<Encoded>& encoded = under_way[i];
        if (const std::lock_guard lock(guard); !free.empty()) {
          encoded = std::move(free.back());
          free.pop_back();
        }
        if (encoded == nullptr) encoded = std::make_unique<Encoded>();
        encoded->row = encoded->encoder.encode(tile(i));
      },
      [&](std::size_t i) {
        put_row(under_way[i]->row);
        const std::lock_guard lock(guard);
        free.push_back(std::move(under_way[i]));
      });
}

void SqliteMapWriter::put_row(const TileRow& row) {
  write([&] {
    Statement& put = puts_->tile;
    bind_tile(put, {static_cast<std::size_t>(row.submap), row.key});
    int parameter = 4;
    for (const std::int64_t number : {row.points, row.colored}) put.bind(++parameter, number);
    for (const double coordinate : row.origin) put.bind(++parameter, coordinate);
    for (const std::span<const std::byte> blob : row.blobs) {
      ++parameter;
      blob.empty() ? put.bind_null(parameter) : put.bind(parameter, blob);
    }
    put.bind(++parameter, static_cast<std::int64_t>(row.checksum));
    put.run();
  });
}

}  // namespace

std::unique_ptr<MapWriter> MapWriter::create(const fs::path& path, bool force) {
  return std::make_unique<SqliteMapWriter>(path, force);
}

void fold_log(const fs::path& path) {
  std::error_code ignored;
  const fs::path file = fs::canonical(path, ignored);
  if (!has_side_files(file)) return;
  try {
    MapWriter::open(file);  // whose end it is to do so
  } catch (const Error&) {  // somebody writes it: then it is theirs to do
  }
}

std::unique_ptr<MapWriter> MapWriter::open(const fs::path& path) {
  if (fs::is_regular_file(path)) {
    // Where a program was killed, its last commit may still lie in a journal.
    Database(path, Access::kWrite, path).attempt("SELECT count(*) FROM sqlite_master");
  }
  { const MapReader check(path); }  // the same refusals as for reading
  return std::make_unique<SqliteMapWriter>(path);
}

}  // namespace fovea
