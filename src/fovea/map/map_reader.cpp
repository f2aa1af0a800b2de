#include <fmt/format.h>

#include <utility>

#include "fovea/base/errors.h"
#include "fovea/map/map_digest.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/map_store.h"
#include "fovea/map/number_text.h"
#include "fovea/map/sqlite_database.h"
#include "fovea/map/tile_codec.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;
using sqlite::Access;
using sqlite::Statement;

constexpr const char* kFrameColumns =
    "idx, stamp_ns, status, note, pose, navigation_pose, odom_pose, submap, revisited, "
    "revisited_pose, velocity, figures";
constexpr int kFrameColumnCount = 12, kStampColumn = 1, kSubmapColumn = 7, kRevisitedColumn = 8;
constexpr const char* kRestore = "restore the map from a copy or map the drive again";

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
  if (database->attempt("SELECT count(*) FROM sqlite_master") == sqlite::Outcome::kFailed &&
      !has_log(path)) {
    database = std::make_unique<sqlite::Database>(path, Access::kReadImmutable, path);
  }
  return database;
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
                     version > kMapSchemaVersion ? "use a newer Fovea" : "map the drive again");
  }
}

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

TileRow tile_row(const Statement& statement, const std::string& map_path) {
  const auto key = [&](int column) {
    const std::int64_t value = statement.integer(column);
    if (!std::in_range<std::int32_t>(value)) {
      throw InputError(fmt::format("a tile has the impossible key {}", value), map_path, kRestore);
    }
    return static_cast<std::int32_t>(value);
  };
  TileRow row;
  row.submap = statement.integer(0);
  row.key = {key(1), key(2), key(3)};
  row.points = statement.integer(4);
  row.colored = statement.integer(5);
  row.origin = {statement.real(6), statement.real(7), statement.real(8)};
  for (int i = 0; i < static_cast<int>(kStoredColumns); ++i) row.blobs[i] = statement.blob(9 + i);
  row.checksum = static_cast<std::uint64_t>(statement.integer(9 + int{kStoredColumns}));
  return row;
}

std::optional<int> submap_number(std::int64_t value) {
  if (value < -1 || !std::in_range<int>(value)) return std::nullopt;
  return static_cast<int>(value);
}

FrameRecord frame_record(const Statement& row, const std::string& map_path) {
  if (!std::in_range<int>(row.integer(0))) {
    throw InputError(fmt::format("a frame has the impossible index {}", row.integer(0)), map_path,
                     kRestore);
  }
  FrameRecord record;
  record.index = static_cast<int>(row.integer(0));
  const auto require = [&](const auto& value, const char* column) {
    if (!value) {
      throw InputError(fmt::format("the column '{}' of a frame cannot be read", column),
                       fmt::format("{}, frame {}", map_path, record.index), kRestore);
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
    record.velocity = require(twist_from_text(row.text(10)), "velocity");
  }
  record.figures = require(numbers_from_json(row.text(11)), "figures");
  record.milliseconds = require(numbers_from_json(row.text(12)), "timings");
  return record;
}

}  // namespace

struct MapReader::Database {
  explicit Database(const fs::path& path) : sqlite(open_for_reading(path)) {
    require_schema(*sqlite);
  }
  std::unique_ptr<sqlite::Database> sqlite;
};

MapReader::MapReader(const fs::path& path) : database_(std::make_unique<Database>(path)) {}
MapReader::~MapReader() = default;
MapReader::MapReader(MapReader&&) noexcept = default;

MapMeta MapReader::meta() const {
  Statement rows(*database_->sqlite, "SELECT key, value FROM meta");
  MapMeta meta;
  while (rows.step()) meta.emplace(rows.text(0), rows.text(1));
  return meta;
}

std::vector<FrameRecord> MapReader::frames() const {
  Statement rows(*database_->sqlite,
                 fmt::format("SELECT {}, timings FROM frames ORDER BY idx", kFrameColumns));
  std::vector<FrameRecord> frames;
  while (rows.step()) frames.push_back(frame_record(rows, database_->sqlite->where()));
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
                       kRestore);
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

void MapReader::for_each_tile(
    const std::function<void(std::size_t, const TileKey&, const PointCloud&)>& f) const {
  sqlite::Database& database = *database_->sqlite;
  const Snapshot snapshot(database);
  const std::size_t submap_count = submaps().size();
  Statement rows(database,
                 "SELECT submap, x, y, z, points, colored, origin_x, origin_y, origin_z, position, "
                 "color, camera, frame, range, incidence, interpolated, views, spread, weight, "
                 "reason, intensity, checksum "
                 "FROM tiles ORDER BY submap, x, y, z");
  TileDecoder decoder;
  while (rows.step()) {
    const TileRow row = tile_row(rows, database.where());
    if (row.submap < 0 || row.submap >= static_cast<std::int64_t>(submap_count)) {
      throw InputError(fmt::format("a tile belongs to submap {}, which is missing", row.submap),
                       database.where(), kRestore);
    }
    f(static_cast<std::size_t>(row.submap), row.key, decoder.decode(row, database.where()));
  }
}

PointCloud MapReader::all_points_local() const {
  const Snapshot snapshot(*database_->sqlite);
  const std::vector<RigidMotion> T_local_submap = submaps();
  PointCloud points_local;
  for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    PointCloud tile_local = tile;
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
  for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
    digest.row(static_cast<std::int64_t>(submap), std::int64_t{key.x}, std::int64_t{key.y},
               std::int64_t{key.z}, static_cast<std::int64_t>(tile.size()), tile.origin.x(),
               tile.origin.y(), tile.origin.z());
    std::size_t i = 0;
    for_each_stored_column(tile, [&](const auto& column) {
      const bool missing = i++ == kIntensityColumn && column.empty();
      missing ? digest.null() : digest.value(std::as_bytes(std::span(column)));
    });
  });
  return digest.hex();
}

}  // namespace fovea
