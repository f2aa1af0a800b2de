// Over 300 lines: one class, whose methods share the state of one transaction.
#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "fovea/core/output_file.h"
#include "fovea/core/parallel.h"
#include "fovea/core/sqlite_database.h"
#include "fovea/core/unfinished_output.h"
#include "fovea/errors.h"
#include "fovea/map/map_format.h"
#include "fovea/map/map_log.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/map_statements.h"
#include "fovea/map/map_store.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/record_rows.h"
#include "fovea/map/tile_query.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using sqlite::Access;
using sqlite::Database;
using sqlite::Outcome;
using sqlite::Statement;

class SqliteMapWriter : public MapWriter {
 public:
  /// A new map, which grows in PATH.partial until its first commit.
  SqliteMapWriter(const fs::path& path, bool force)
      : path_(path), target_(check_output_path(path, force)), force_(force) {
    merge_old_map(target_);  // an error before a long run, not after it
    partial_ = partial_path(target_);
    unfinished_.emplace(path_, std::vector{partial_}, [this] { start_partial_file(); });
  }

  /// A new map, which grows in a folder of its own until its end.
  SqliteMapWriter(const fs::path& path, bool force, const fs::path& scratch)
      : path_(path), target_(check_output_path(path, force)), force_(force) {
    if (!log_of_map(target_).empty()) merge_old_map(target_);
    partial_ = scratch / scratch_name(target_);
    copy_ = target_.parent_path() / scratch_name(target_);
    unfinished_.emplace(path_, std::vector{partial_, copy_}, [this] { start_partial_file(); });
  }

  /// An existing map.
  explicit SqliteMapWriter(const fs::path& path)
      : path_(path), target_(check_output_path(path, true)), force_(true), published_(true) {
    open_published_file();
  }

  ~SqliteMapWriter() override {
    statements_.reset();
    if (database_ != nullptr && published_) {
      database_->attempt("ROLLBACK");
      leave_one_file(*database_);
    }
    const bool drop = database_ != nullptr && !published_;
    database_.reset();
    if (drop) remove_partial_file();
  }

  void put_meta(const std::string& key, const std::string& value) override {
    if (key == meta_key::kFormatVersion) {
      throw std::invalid_argument(fmt::format("the meta key '{}' is the store's own", key));
    }
    put(kMetaTable, meta_row(key, value));
  }
  void put_drive(std::size_t id, const DriveRecord& drive) override {
    put(kDrivesTable, drive_row(id, drive));
  }
  void put_sensor(std::size_t id, const SensorRecord& sensor) override {
    put(kSensorsTable, sensor_row(id, sensor));
  }
  void put_submap(std::size_t id, const SubmapRecord& submap) override {
    put(kSubmapsTable, submap_row(id, submap));
  }
  void put_keyframe(const KeyframeRecord& keyframe) override {
    std::vector<std::byte> blob;
    put(kKeyframesTable, keyframe_row(keyframe, blob));
  }
  void put_checkpoint(const std::string& name, const CheckpointRecord& checkpoint) override {
    std::vector<std::byte> blob;
    put(kCheckpointTable, checkpoint_row(name, checkpoint, blob));
  }
  void put_frame(const FrameRecord& record) override;
  void put_pose(int frame, const RigidMotion& T_local_lidar) override;
  void put_tile(const PackedTile& tile) override { put_row(encoder_.encode(tile)); }
  void put_tiles(std::size_t count, const std::function<PackedTile(std::size_t)>& tile) override;
  void remove_tile(const TileId& id) override;
  TilePoints read_tile(const TileId& id) override;

  void commit() override {
    if (!copy_.empty()) return;  // of use only when it is whole
    write([&] {
      put_counts();
      database_->execute("COMMIT");
      if (!published_) {
        publish();
        open_published_file();
      } else {
        // A reader may hold the log; then a later commit moves its pages.
        database_->attempt("PRAGMA wal_checkpoint(PASSIVE)");
        database_->execute("BEGIN IMMEDIATE");
      }
    });
  }

  void finish(std::chrono::milliseconds reader_timeout) override {
    write([&] {
      put_counts();
      database_->execute("COMMIT");
      if (!published_) {
        publish();
      } else {
        merge_log(*database_, target_, reader_timeout);
      }
    });
    ended_ = true;
  }

 private:
  /// Runs a step of writing; after a failure SQLite may have ended the transaction, so that a later
  /// step would be written on its own.
  template <class Step>
  void write(Step&& step) {
    if (ended_) throw std::logic_error("a map is written on after its end or an error");
    ended_ = true;
    step();
    ended_ = false;
  }

  void put(const Table& table, const Row& row) {
    const std::uint64_t checksum = row_checksum(table, row);
    write([&] { insert_row(statements_->insert(table), row, checksum); });
  }
  void put_row(const TileRow& row) {
    write([&] { insert_row(statements_->insert(kTilesTable), cells_of(row), row.checksum); });
  }
  /// Stores how many rows each table has, so that a missing row is found.
  void put_counts();

  void start_partial_file();
  void remove_partial_file();
  void publish();
  void open_published_file();

  fs::path path_;     // as the user named it
  fs::path target_;   // the file itself, where path_ is a symbolic link
  fs::path partial_;  // where a new map grows
  fs::path copy_;     // next to the target, of a map that grows in a scratch folder; or empty
  bool force_;
  bool published_ = false;
  bool ended_ = false;                          // by finish() or by an error
  std::optional<UnfinishedOutput> unfinished_;  // of a new map
  TileEncoder encoder_;
  std::unique_ptr<Database> database_;
  std::unique_ptr<MapStatements> statements_;
};

void SqliteMapWriter::start_partial_file() {
  if (fs::exists(partial_)) {
    // Left by a killed program, unless one still has its lock.
    Database left(partial_, Access::kWrite, path_);
    if (left.attempt("BEGIN EXCLUSIVE") == Outcome::kBusy) left.throw_busy();
    fs::remove(partial_);
  }
  remove_side_files(partial_);
  const bool is_in_scratch = !copy_.empty();
  database_ =
      std::make_unique<Database>(partial_, Access::kCreate, is_in_scratch ? partial_ : path_);
  try {
    // A file that is thrown away on any failure needs no journal, and one sync when it is whole.
    database_->execute(
        fmt::format("PRAGMA page_size={}; PRAGMA locking_mode=EXCLUSIVE; PRAGMA journal_mode=OFF;"
                    "PRAGMA synchronous=OFF; PRAGMA application_id={}; PRAGMA user_version={};"
                    "BEGIN EXCLUSIVE;",
                    kPageSize, kMapApplicationId, kMapFormatVersion)
            .c_str());
    for (const Table* table : kTables) database_->execute(create_sql(*table).c_str());
    statements_ = std::make_unique<MapStatements>(*database_);
    put(kMetaTable, meta_row(meta_key::kFormatVersion, fmt::to_string(kMapFormatVersion)));
  } catch (...) {
    statements_.reset();
    database_.reset();
    remove_partial_file();
    throw;
  }
}

void SqliteMapWriter::remove_partial_file() {
  std::error_code ignored;
  fs::remove(partial_, ignored);
  remove_side_files(partial_);
}

void SqliteMapWriter::publish() {
  if (copy_.empty()) {
    // Another program may have made the file meanwhile.
    check_output_path(path_, force_);
    remove_old_map_logs(target_);
    publish_file(partial_, target_, *unfinished_);
  } else {
    // A second run of the same job may have made the file meanwhile: with the same content.
    publish_copy(partial_, copy_, target_, *unfinished_);
  }
  published_ = true;
  statements_.reset();
  database_.reset();
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
  statements_ = std::make_unique<MapStatements>(*database_);
}

void SqliteMapWriter::put_frame(const FrameRecord& record) {
  put(kFramesTable, frame_row(record));
  write([&] {
    statements_->no_views.bind(1, std::int64_t{record.index});
    statements_->no_views.run();
  });
  for (const ViewRecord& view : record.views) put(kViewsTable, view_row(record.index, view));
}

void SqliteMapWriter::put_pose(int frame, const RigidMotion& T_local_lidar) {
  std::optional<FrameRecord> record;
  write([&] {
    Statement& row = statements_->frame;
    row.bind(1, std::int64_t{frame});
    if (row.step()) {
      const StoredRow stored = stored_row(row, kFramesTable);
      // A new checksum would hide the damage.
      require_whole(kFramesTable, stored, path_.string());
      record = frame_of(RowCursor(kFramesTable, stored.row, path_.string()));
    }
    row.reset();
  });
  if (!record) return;
  record->T_local_lidar = T_local_lidar;
  put(kFramesTable, frame_row(*record));
}

void SqliteMapWriter::put_counts() {
  for (const Table* table : kTables) {
    if (table == &kCountsTable) continue;
    const std::string count = fmt::format("SELECT count(*) FROM {}", table->name);
    const Row row{cell(std::string(table->name)), cell(database_->integer(count.c_str()))};
    insert_row(statements_->insert(kCountsTable), row, row_checksum(kCountsTable, row));
  }
}

void SqliteMapWriter::remove_tile(const TileId& id) {
  write([&] {
    bind_tile(statements_->no_tile, id);
    statements_->no_tile.run();
  });
}

TilePoints SqliteMapWriter::read_tile(const TileId& id) {
  TilePoints tile;
  write([&] { tile = statements_->read_tile.read(id, path_.string()); });
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

}  // namespace

std::unique_ptr<MapWriter> MapWriter::create(const fs::path& path, bool force,
                                             const fs::path& scratch) {
  if (scratch.empty()) return std::make_unique<SqliteMapWriter>(path, force);
  return std::make_unique<SqliteMapWriter>(path, force, scratch);
}

std::unique_ptr<MapWriter> MapWriter::open(const fs::path& path) {
  if (fs::is_regular_file(path)) {
    // Where a program was killed, its last commit may still lie in a journal.
    Database(path, Access::kWrite, path).attempt("SELECT count(*) FROM sqlite_master");
  }
  const int version = MapReader(path).format_version();  // the same refusals as for reading
  if (version != kMapFormatVersion) {
    throw InputError(fmt::format("the map has format version {}, which is only read", version),
                     path.string(),
                     fmt::format("rewrite it in format {} first: fovea repair {} -o OUT",
                                 kMapFormatVersion, path.string()));
  }
  return std::make_unique<SqliteMapWriter>(path);
}

}  // namespace fovea
