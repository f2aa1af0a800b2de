// The rows of a map behind SQLite, checksums and zstd: a small map with cells from the input. The
// checksums of its tiles are right, and mostly those of the other rows, too.
#include <fmt/format.h>
#include <fuzzer/FuzzedDataProvider.h>
#include <sqlite3.h>
#include <zstd.h>

#include <deque>
#include <fstream>
#include <sstream>

#include "fovea/map/map_row.h"
#include "fovea/map/tile_codec.h"
#include "fuzz_input.h"
#include "map_reading.h"
#include "sample_tile.h"
#include "scratch_folder.h"

using namespace fovea;

namespace {

void put_other_rows(MapWriter& map) {
  DriveRecord drive;
  drive.end_frame = 2;
  drive.origin = GeodeticPoint{49, 8, 110};
  drive.height_type = HeightType::kEllipsoidal;
  drive.source_digest = "digest";
  map.put_drive(0, drive);
  SensorRecord sensor;
  sensor.profile.ring_elevations = {0.1, -0.1};
  map.put_sensor(0, sensor);
  SubmapRecord submap;
  submap.covariance = Eigen::Matrix<double, 6, 6>::Identity();
  submap.log2_gain = Eigen::Vector3d(0, 1, 2);
  map.put_submap(0, submap);
  map.put_keyframe({0, 0, {0.1, -0.1}, 2, 0, 0.01, {0, 1, 700, 65535}});
  map.put_checkpoint("tracker", {1, {std::byte{7}}});
}

/// A map as the project writes it: a mapped and a skipped frame, a submap, a tile.
std::string sample_map(const std::filesystem::path& path) {
  const auto map = MapWriter::create(path, true);
  map->put_meta("config", "[registration]\nmethod = \"gicp\"\n");
  FrameRecord frame;
  frame.index = 0;
  frame.stamp = 1'317'046'453'072'943'357;
  frame.T_local_lidar_navigation = RigidMotion::Identity();
  frame.motion = SweepMotion{Twist::Ones(), Twist::Constant(0.5)};
  frame.submap = 0;
  frame.revisit = Revisit{};
  frame.figures = {{"points_scan", 19'329}};
  frame.views = {{2, frame.stamp, Eigen::Vector3d(0.5, 0, -0.5)}, {3, std::nullopt, std::nullopt}};
  map->put_frame(frame);
  FrameRecord skipped;
  skipped.index = 1;
  skipped.status = FrameStatus::kSkipped;
  skipped.note = "no scan";
  map->put_frame(skipped);
  put_other_rows(*map);
  map->put_tile({0, {0, 0, 0}}, sample_tile());
  map->commit();
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

class Sql {
 public:
  explicit Sql(const std::filesystem::path& path) {
    require(sqlite3_open(path.c_str(), &handle_) == SQLITE_OK, "a map can be opened");
    run("PRAGMA synchronous=OFF; PRAGMA journal_mode=MEMORY; BEGIN");
  }
  ~Sql() {
    run("COMMIT");
    sqlite3_close(handle_);
  }
  Sql(const Sql&) = delete;
  Sql& operator=(const Sql&) = delete;

  void run(const char* sql) { sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr); }

  /// Runs a statement whose parameters are bound by `bind`; what the schema refuses is left out.
  template <class Bind>
  void run(const std::string& sql, Bind&& bind) {
    sqlite3_stmt* statement = nullptr;
    require(sqlite3_prepare_v2(handle_, sql.c_str(), -1, &statement, nullptr) == SQLITE_OK, sql);
    bind(statement);
    sqlite3_step(statement);
    sqlite3_finalize(statement);
  }

 private:
  sqlite3* handle_ = nullptr;
};

void bind_any(FuzzedDataProvider& input, sqlite3_stmt* statement, int parameter) {
  switch (input.ConsumeIntegralInRange(0, 4)) {
    case 0:
      sqlite3_bind_null(statement, parameter);
      break;
    case 1:
      sqlite3_bind_int64(statement, parameter, input.ConsumeIntegral<std::int64_t>());
      break;
    case 2:
      sqlite3_bind_double(statement, parameter, input.ConsumeFloatingPoint<double>());
      break;
    default: {
      const std::string bytes = input.ConsumeRandomLengthString();
      const int size = static_cast<int>(bytes.size());
      input.ConsumeBool()
          ? sqlite3_bind_text(statement, parameter, bytes.data(), size, SQLITE_TRANSIENT)
          : sqlite3_bind_blob(statement, parameter, bytes.data(), size, SQLITE_TRANSIENT);
    }
  }
}

void change_cell(FuzzedDataProvider& input, Sql& sql) {
  // A column of a table in one of its rows, or in all of them.
  const Table& table = *kTables[input.ConsumeIntegralInRange<std::size_t>(0, kTables.size() - 1)];
  const std::size_t last = table.column_count() - 1;
  const char* column = table.columns[input.ConsumeIntegralInRange<std::size_t>(0, last)].name;
  const std::string update = fmt::format("{} SET {}=?1", table.name, column);
  sql.run("UPDATE " + update, [&](sqlite3_stmt* s) { bind_any(input, s, 1); });
}

/// A row whose blobs are copies in `blobs`.
Row own_row(Row row, std::deque<std::vector<std::byte>>& blobs) {
  for (Cell& cell : row) {
    if (const auto* blob = std::get_if<std::span<const std::byte>>(&cell)) {
      cell = std::span<const std::byte>(blobs.emplace_back(blob->begin(), blob->end()));
    }
  }
  return row;
}

void set_counts(sqlite::Database& database) {
  for (const Table* table : kTables) {
    if (table == &kCountsTable) continue;
    database.attempt(fmt::format("UPDATE counts SET row_count=(SELECT count(*) FROM {0}) "
                                 "WHERE table_name='{0}'",
                                 table->name)
                         .c_str());
  }
}

/// Writes the checksum that belongs to each row of a table, and the number of the rows.
void mend(const std::filesystem::path& path) {
  sqlite::Database database(path, sqlite::Access::kWrite, path);
  database.execute("PRAGMA synchronous=OFF; PRAGMA journal_mode=MEMORY; BEGIN");
  for (const Table* table : kTables) {
    if (table == &kTilesTable) continue;
    if (table == &kCountsTable) set_counts(database);
    std::vector<Row> rows;
    std::deque<std::vector<std::byte>> blobs;
    {
      sqlite::Statement stored(database, select_sql(*table));
      while (stored.step()) rows.push_back(own_row(stored_row(stored, *table).row, blobs));
    }
    database.execute(fmt::format("DELETE FROM {}", table->name).c_str());
    sqlite::Statement insert(database, insert_sql(*table));
    for (const Row& row : rows) insert_row(insert, row, row_checksum(*table, row));
  }
  database.execute("COMMIT");
}

std::string compressed(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}

/// A column: of the right size, of any, as the input packs it, or missing.
std::string any_blob(FuzzedDataProvider& input, std::size_t column, std::int64_t points) {
  constexpr std::int64_t kLargest = 1 << 12;
  switch (input.ConsumeIntegralInRange(0, 7)) {
    case 0:
      return compressed(input.ConsumeRandomLengthString());
    case 1:
      return input.ConsumeRandomLengthString();
    case 2:
      return {};
    default:
      const PackedSizes sizes = packed_sizes(
          column, static_cast<std::size_t>(std::clamp<std::int64_t>(points, 0, kLargest)));
      const std::size_t size =
          sizes.least + sizes.step * input.ConsumeIntegralInRange<std::size_t>(
                                         0, (sizes.most - sizes.least) / sizes.step);
      std::string bytes = input.ConsumeBytesAsString(size);
      bytes.resize(size);
      return compressed(bytes);
  }
}

std::int64_t any_small(FuzzedDataProvider& input, std::int64_t most) {
  return input.ConsumeIntegralInRange(0, 15) == 0
             ? input.ConsumeIntegral<std::int64_t>()
             : input.ConsumeIntegralInRange<std::int64_t>(0, most);
}

/// Coloured points of a tile, where its column of cameras can be read.
std::int64_t colored_by(std::size_t column, const std::string& cameras) {
  std::vector<std::byte> bytes(1 << 13);
  const std::size_t size =
      ZSTD_decompress(bytes.data(), bytes.size(), cameras.data(), cameras.size());
  if (ZSTD_isError(size)) return 0;
  TilePoints tile;
  unpack_column(column, std::span(bytes).first(size), 0, tile);
  return count_colored(tile);
}

void put_tile(FuzzedDataProvider& input, Sql& sql) {
  constexpr std::size_t kCameraColumn = 2;
  TileRow row;
  row.submap = any_small(input, 1);
  row.key = {static_cast<std::int32_t>(any_small(input, 2)), 0, 0};
  row.points = any_small(input, 40);
  for (int axis = 0; axis < 3; ++axis) {
    row.origin[axis] = input.ConsumeBool() ? 4.0 * row.key.x : input.ConsumeFloatingPoint<double>();
  }
  std::array<std::string, kStoredColumns> blobs;
  for (std::size_t i = 0; i < kStoredColumns; ++i) {
    blobs[i] = any_blob(input, i, row.points);
    row.blobs[i] = std::as_bytes(std::span(blobs[i]));
  }
  const std::int64_t colored = colored_by(kCameraColumn, blobs[kCameraColumn]);
  row.colored = input.ConsumeIntegralInRange(0, 7) == 0 ? any_small(input, 40) : colored;
  row.checksum = checksum(row);
  sql.run(insert_sql(kTilesTable), [&](sqlite3_stmt* s) {
    int parameter = 0;
    for (const std::int64_t number : {row.submap, std::int64_t{row.key.x}, std::int64_t{row.key.y},
                                      std::int64_t{row.key.z}, row.points, row.colored}) {
      sqlite3_bind_int64(s, ++parameter, number);
    }
    for (const double number : row.origin) sqlite3_bind_double(s, ++parameter, number);
    for (std::size_t i = 0; i < kStoredColumns; ++i) {
      const std::string& blob = blobs[i];
      ++parameter;
      if (i >= kFirstOptionalColumn && blob.empty()) continue;  // NULL
      sqlite3_bind_blob(s, parameter, blob.data(), static_cast<int>(blob.size()), SQLITE_STATIC);
    }
    sqlite3_bind_int64(s, ++parameter, static_cast<std::int64_t>(row.checksum));
  });
}

/// What is read of a tile is what is written for it, bit for bit.
void write_and_read_again(const std::filesystem::path& path) {
  read_or_refuse([&] {
    TileEncoder encoder;
    TileDecoder decoder;
    MapReader(path).for_each_tile(
        [&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
          const PackedTile packed = pack_tile({submap, key}, TilePoints::of(tile));
          const TilePoints again = decoder.decode(encoder.encode(packed), "again");
          require(packed.columns == pack_columns(again) && tile.origin == again.origin,
                  "a tile is written as it is read");
        });
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  static const std::string sample = sample_map(folder / "a.fovea");
  const std::filesystem::path path = folder / "a.fovea";
  std::ofstream(path, std::ios::binary) << sample;
  FuzzedDataProvider input(data, size);
  const auto way = input.ConsumeIntegral<std::uint8_t>();
  {
    Sql sql(path);
    for (int changes = 0; changes < 8 && input.remaining_bytes() > 0; ++changes) {
      input.ConsumeBool() ? put_tile(input, sql) : change_cell(input, sql);
    }
  }
  // Without mending, checksums and counts refuse the map before any value is read.
  if (way % 16 != 15) mend(path);
  use_map(path, way);
  if (way % 3 == 0) write_and_read_again(path);
  folder.clear();
  return 0;
}
