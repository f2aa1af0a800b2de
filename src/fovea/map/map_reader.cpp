#include <fmt/format.h>

#include <array>
#include <utility>

#include "fovea/base/errors.h"
#include "fovea/map/map_digest.h"
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
using sqlite::Statement;

constexpr const char* kFrameColumns =
    "idx, stamp_ns, status, note, pose, navigation_pose, odom_pose, submap, revisited, "
    "revisited_pose, velocity, figures";
constexpr int kFrameColumnCount = 12, kStampColumn = 1, kSubmapColumn = 7, kRevisitedColumn = 8;

void require_file(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) {
    throw InputError("the map does not exist", path.string(), "check the name");
  }
  if (!fs::is_regular_file(status)) {
    throw InputError("not a file", path.string(), "give a map that 'fovea map' wrote");
  }
  if (fs::file_size(path, ignored) == 0) {
    throw InputError("the file is empty", path.string(), "give a map that 'fovea map' wrote");
  }
}

/// A map whose log is empty can be read without side files: from a read-only folder, say.
bool has_log(const fs::path& path) {
  std::error_code ignored;
  for (const char* ending : {"-wal", "-journal"}) {
    const fs::path side = fs::path(path) += ending;
    if (fs::exists(side, ignored) && fs::file_size(side, ignored) > 0) return true;
  }
  return false;
}

std::unique_ptr<sqlite::Database> open_for_reading(const fs::path& path) {
  require_file(path);
  auto database = std::make_unique<sqlite::Database>(path, Access::kRead, path);
  // SQLite reads nothing before the first statement.
  constexpr const char* kLook = "SELECT count(*) FROM sqlite_master";
  if (database->attempt(kLook) != sqlite::Outcome::kFailed) return database;
  if (!has_log(path)) {
    return std::make_unique<sqlite::Database>(path, Access::kReadImmutable, path);
  }
  // A program was killed while it changed how the file is journalled: whoever may write sets the
  // file right, and then it can be read.
  sqlite::Database(path, Access::kWrite, path).attempt(kLook);
  return std::make_unique<sqlite::Database>(path, Access::kRead, path);
}

void require_schema(sqlite::Database& database) {
  if (database.integer("PRAGMA application_id") != kMapApplicationId) {
    throw InputError("an SQLite file, but not a Fovea map", database.where(),
                     "give a file that 'fovea map' wrote");
  }
  const std::int64_t version = database.integer("PRAGMA user_version");
  if (version != kMapSchemaVersion) {
    throw InputError(fmt::format("the map has format version {}, this program reads {}", version,
                                 kMapSchemaVersion),
                     database.where(),
                     version > kMapSchemaVersion
                         ? "use a newer Fovea"
                         : "map the drive again (fovea map DRIVE -o MAP --force)");
  }
}

/// InputError of a tile that the map should not have so.
[[noreturn]] void fail_at(const TileId& id, const char* what, const std::string& map_path) {
  throw InputError(what,
                   fmt::format("{}, tile {} {} {} of submap {}", map_path, id.key.x, id.key.y,
                               id.key.z, id.submap),
                   kRestoreMap);
}

/// The order of the tiles, which SQLite takes from the file.
class TileOrder {
 public:
  explicit TileOrder(std::string map_path) : map_path_(std::move(map_path)) {}
  void require_after_last(const TileId& id) {
    if (last_ && id <= *last_) fail_at(id, "the tiles are not in order", map_path_);
    last_ = id;
  }

 private:
  std::string map_path_;
  std::optional<TileId> last_;
};

/// While it lives, all statements see one committed state; they may nest.
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

PointCloud passing(const PointCloud& tile, const PointFilter& where) {
  if (where.empty()) return tile;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < tile.size(); ++i) {
    if (where.matches(tile, i)) indices.push_back(i);
  }
  return tile.select(indices);
}

std::optional<int> submap_number(std::int64_t value) {
  if (value < -1 || !std::in_range<int>(value)) return std::nullopt;
  return static_cast<int>(value);
}

FrameRecord frame_record(const Statement& row, const std::string& map_path) {
  if (!std::in_range<int>(row.integer(0))) {
    throw InputError(fmt::format("a frame has the impossible index {}", row.integer(0)), map_path,
                     kRestoreMap);
  }
  FrameRecord record;
  record.index = static_cast<int>(row.integer(0));
  const auto require = [&](const auto& value, const char* column) {
    if (!value) {
      throw InputError(fmt::format("the column '{}' of a frame cannot be read", column),
                       fmt::format("{}, frame {}", map_path, record.index), kRestoreMap);
    }
    return *value;
  };
  if (!row.is_null(1)) record.stamp = row.integer(1);
  record.status = require(frame_status(row.text(2)), "status");
  record.note = row.text(3);
  record.T_local_lidar = require(motion_from_text(row.text(4)), "pose");
  if (!row.is_null(5)) {
    record.T_local_lidar_navigation = require(motion_from_text(row.text(5)), "navigation_pose");
  }
  record.T_odom_lidar = require(motion_from_text(row.text(6)), "odom_pose");
  record.submap = require(submap_number(row.integer(7)), "submap");
  if (!row.is_null(8)) {
    record.revisit = Revisit{require(submap_number(row.integer(8)), "revisited"),
                             require(motion_from_text(row.text(9)), "revisited_pose")};
  }
  if (!row.is_null(10)) {
    record.motion = require(sweep_motion_from_text(row.text(10)), "velocity");
  }
  record.figures = require(numbers_from_json(row.text(11)), "figures");
  record.milliseconds = require(numbers_from_json(row.text(12)), "timings");
  return record;
}

}  // namespace

struct MapReader::Database {
  Database(const fs::path& path, std::function<void(const std::string&)> on_damage_)
      : sqlite(open_for_reading(path)), on_damage(std::move(on_damage_)) {
    // Only so does SQLite open a file that is shorter than it should be.
    if (on_damage) sqlite->attempt("PRAGMA writable_schema=ON");
    require_schema(*sqlite);
  }
  /// Does a step of reading; where damage is to be told of, tells of it and returns false.
  template <class Step>
  bool read(Step&& step) {
    if (!on_damage) {
      step();
      return true;
    }
    try {
      step();
      return true;
    } catch (const InputError& error) {
      on_damage(error.problem() + ", " + error.where());
      return false;
    }
  }
  TileQuery& tile() {
    if (!tile_query) tile_query.emplace(*sqlite);
    return *tile_query;
  }
  void for_each_tile(const std::function<void(const TileRow&)>& f);
  void for_each_whole_tile(const std::function<void(const TileRow&)>& f);

  std::unique_ptr<sqlite::Database> sqlite;
  std::function<void(const std::string&)> on_damage;
  std::optional<TileQuery> tile_query;  // once it is needed
};

void MapReader::Database::for_each_tile(const std::function<void(const TileRow&)>& f) {
  if (on_damage) return for_each_whole_tile(f);
  Statement rows(*sqlite,
                 fmt::format("SELECT {} FROM tiles ORDER BY submap, x, y, z", kTileColumns));
  while (rows.step()) f(tile_row(rows, sqlite->where()));
}

void MapReader::Database::for_each_whole_tile(const std::function<void(const TileRow&)>& f) {
  // First the keys, which stand apart: one row that cannot be read ends a query.
  std::vector<std::array<std::int64_t, 4>> keys;
  read([&] {
    Statement rows(*sqlite, "SELECT submap, x, y, z FROM tiles ORDER BY submap, x, y, z");
    while (rows.step()) {
      keys.push_back({rows.integer(0), rows.integer(1), rows.integer(2), rows.integer(3)});
    }
  });
  for (const auto& key : keys) {
    read([&] {
      Statement row(*sqlite, fmt::format("SELECT {} FROM tiles WHERE {}", kTileColumns, kThisTile));
      for (int i = 0; i < 4; ++i) row.bind(i + 1, key[std::size_t(i)]);
      bool is_there = false;
      try {
        is_there = row.step();
      } catch (const InputError&) {
        // Named below: SQLite says of the file alone that it is damaged.
      }
      if (!is_there) {
        throw InputError("a tile cannot be read",
                         fmt::format("{}, tile {} {} {} of submap {}", sqlite->where(), key[1],
                                     key[2], key[3], key[0]),
                         kRestoreMap);
      }
      f(tile_row(row, sqlite->where()));
    });
  }
}

MapReader::MapReader(const fs::path& path) : MapReader(path, {}) {}
MapReader::MapReader(const fs::path& path, std::function<void(const std::string&)> on_damage)
    : database_(std::make_unique<Database>(path, std::move(on_damage))) {}
MapReader::~MapReader() = default;
MapReader::MapReader(MapReader&&) noexcept = default;

std::shared_ptr<const void> MapReader::hold_state() const {
  return std::make_shared<const Snapshot>(*database_->sqlite);
}

MapMeta MapReader::meta() const {
  Statement rows(*database_->sqlite, "SELECT key, value FROM meta");
  MapMeta meta;
  while (rows.step()) meta.emplace(rows.text(0), rows.text(1));
  return meta;
}

std::vector<FrameRecord> MapReader::frames() const {
  Statement rows(*database_->sqlite,
                 fmt::format("SELECT {}, timings FROM frames ORDER BY idx", kFrameColumns));
  const std::string where = database_->sqlite->where();
  std::vector<FrameRecord> frames;
  bool more = true;
  while (database_->read([&] { more = rows.step(); }) && more) {
    database_->read([&] {
      FrameRecord frame = frame_record(rows, where);
      // SQLite takes the order from the file. Of a damaged one every whole frame is wanted.
      if (!database_->on_damage && !frames.empty() && frame.index <= frames.back().index) {
        throw InputError("the frames are not in order",
                         fmt::format("{}, frame {}", where, frame.index), kRestoreMap);
      }
      frames.push_back(std::move(frame));
    });
  }
  return frames;
}

std::vector<RigidMotion> MapReader::submaps() const {
  Statement rows(*database_->sqlite, "SELECT id, pose FROM submaps ORDER BY id");
  std::vector<RigidMotion> submaps;
  while (rows.step()) {
    const std::optional<RigidMotion> pose = motion_from_text(rows.text(1));
    if (!pose || rows.integer(0) != static_cast<std::int64_t>(submaps.size())) {
      throw InputError("a submap is missing or its pose cannot be read",
                       fmt::format("{}, submap {}", database_->sqlite->where(), submaps.size()),
                       kRestoreMap);
    }
    submaps.push_back(*pose);
  }
  return submaps;
}

std::size_t MapReader::size() const {
  return static_cast<std::size_t>(
      database_->sqlite->integer("SELECT coalesce(sum(points), 0) FROM tiles"));
}

std::size_t MapReader::colored_size() const {
  return static_cast<std::size_t>(
      database_->sqlite->integer("SELECT coalesce(sum(colored), 0) FROM tiles"));
}

std::vector<std::pair<TileId, std::size_t>> MapReader::tile_sizes() const {
  const std::string where = database_->sqlite->where();
  const Snapshot snapshot(*database_->sqlite);
  const std::size_t submap_count = submaps().size();
  Statement rows(*database_->sqlite,
                 "SELECT submap, x, y, z, points FROM tiles ORDER BY submap, x, y, z");
  std::vector<std::pair<TileId, std::size_t>> sizes;
  TileOrder order(where);
  while (rows.step()) {
    const std::int64_t submap = rows.integer(0), points = rows.integer(4);
    if (submap < 0 || submap >= static_cast<std::int64_t>(submap_count) || points < 0 ||
        points > kMaxTilePoints) {
      throw InputError("a tile has an impossible submap or size", where, kRestoreMap);
    }
    const TileId id{static_cast<std::size_t>(submap), tile_key(rows, 1, where)};
    order.require_after_last(id);
    sizes.emplace_back(id, static_cast<std::size_t>(points));
  }
  return sizes;
}

PointCloud MapReader::read_tile(const TileId& id) const {
  return database_->tile().read(id, database_->sqlite->where()).cloud();
}

std::optional<TilePoints> MapReader::find_tile(const TileId& id) const {
  return database_->tile().find(id, database_->sqlite->where());
}

void MapReader::for_each_tile(
    const std::function<void(std::size_t, const TileKey&, const PointCloud&)>& f) const {
  for_each_stored_tile(
      [&](const TileId& id, const TilePoints& tile) { f(id.submap, id.key, tile.cloud()); });
}

void MapReader::for_each_stored_tile(
    const std::function<void(const TileId&, const TilePoints&)>& f) const {
  sqlite::Database& database = *database_->sqlite;
  const Snapshot snapshot(database);
  const std::size_t submap_count = submaps().size();
  TileDecoder decoder;
  TileOrder order(database.where());
  database_->for_each_tile([&](const TileRow& row) {
    if (row.submap < 0 || row.submap >= static_cast<std::int64_t>(submap_count)) {
      throw InputError(fmt::format("a tile belongs to submap {}, which is missing", row.submap),
                       database.where(), kRestoreMap);
    }
    const TileId id{static_cast<std::size_t>(row.submap), row.key};
    if (!database_->on_damage) order.require_after_last(id);
    f(id, decoder.decode(row, database.where()));
  });
}

PointCloud MapReader::all_points_local(const PointFilter& where) const {
  const Snapshot snapshot(*database_->sqlite);
  const std::vector<RigidMotion> T_local_submap = submaps();
  PointCloud points_local;
  for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
    const bool joins = points_local.empty() || tile.empty() ||
                       points_local.intensity.empty() == tile.intensity.empty();
    if (!joins) {
      fail_at({submap, key}, "only some tiles have intensities", database_->sqlite->where());
    }
    PointCloud tile_local = passing(tile, where);
    tile_local.origin.setZero();
    for (Eigen::Vector3f& p : tile_local.position) {
      p = (T_local_submap[submap] * (tile.origin + p.cast<double>())).cast<float>();
    }
    points_local.append(tile_local);
  });
  return points_local;
}

std::string MapReader::digest() const {
  sqlite::Database& database = *database_->sqlite;
  const Snapshot snapshot(database);
  MapDigest digest;
  digest.section("meta");
  for (const auto& [key, value] : meta()) {
    if (!key.starts_with(kTimingPrefix)) digest.row(key, value);
  }
  digest.section("frames");
  Statement frames(database, fmt::format("SELECT {} FROM frames ORDER BY idx", kFrameColumns));
  while (frames.step()) {
    digest.row(frames.integer(0));
    for (int column = 1; column < kFrameColumnCount; ++column) {
      const bool is_number =
          column == kStampColumn || column == kSubmapColumn || column == kRevisitedColumn;
      if (frames.is_null(column)) {
        digest.null();
      } else if (is_number) {
        digest.value(frames.integer(column));
      } else {
        digest.value(frames.text(column));
      }
    }
  }
  digest.section("submaps");
  Statement submaps(database, "SELECT id, pose FROM submaps ORDER BY id");
  while (submaps.step()) digest.row(submaps.integer(0), submaps.text(1));
  digest.section("tiles");
  for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    digest.row(static_cast<std::int64_t>(id.submap), std::int64_t{id.key.x}, std::int64_t{id.key.y},
               std::int64_t{id.key.z}, static_cast<std::int64_t>(tile.size()), tile.origin.x(),
               tile.origin.y(), tile.origin.z());
    const PackedColumns packed = pack_columns(tile);
    for (std::size_t i = 0; i < kStoredColumns; ++i) {
      const bool missing = i == kIntensityColumn && tile.intensity.empty();
      missing ? digest.null() : digest.value(std::span<const std::byte>(packed[i]));
    }
  });
  return digest.hex();
}

std::vector<RigidMotion> copy_all_but_tiles(const MapReader& map, MapWriter& output) {
  for (const auto& [key, value] : map.meta()) {
    if (key != kSchemaVersionKey) output.put_meta(key, value);
  }
  for (const FrameRecord& frame : map.frames()) output.put_frame(frame);
  std::vector<RigidMotion> T_local_submap = map.submaps();
  for (std::size_t id = 0; id < T_local_submap.size(); ++id) {
    output.put_submap(id, T_local_submap[id]);
  }
  return T_local_submap;
}

}  // namespace fovea
