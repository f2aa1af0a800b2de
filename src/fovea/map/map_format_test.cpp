// The format as docs/map-format.md states it, read without the library's own reader.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <xxhash.h>
#include <zstd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/map_store.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/tile_points.h"

namespace fovea::map_format_test {

struct Raw {
  explicit Raw(const std::filesystem::path& path) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  }
  ~Raw() { sqlite3_close(database); }
  sqlite3* database = nullptr;
};

template <class T>
std::vector<T> inflate(sqlite3_stmt* row, int column, std::size_t count) {
  std::vector<T> values(count);
  EXPECT_EQ(ZSTD_decompress(values.data(), count * sizeof(T), sqlite3_column_blob(row, column),
                            static_cast<std::size_t>(sqlite3_column_bytes(row, column))),
            count * sizeof(T));
  return values;
}

/// Values from runs of equal ones.
template <class T>
std::vector<T> inflate_runs(sqlite3_stmt* row, int column) {
  const std::size_t size =
      ZSTD_getFrameContentSize(sqlite3_column_blob(row, column),
                               static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
  const auto bytes = inflate<std::uint8_t>(row, column, size);
  const std::size_t runs = size / (sizeof(T) + 1);
  std::vector<T> values;
  for (std::size_t i = 0; i < runs; ++i) {
    std::array<std::uint8_t, sizeof(T)> of_value;
    for (std::size_t k = 0; k < sizeof(T); ++k) of_value[k] = bytes[k * runs + i];
    values.insert(values.end(), bytes[sizeof(T) * runs + i] + 1u, std::bit_cast<T>(of_value));
  }
  return values;
}

/// Whole numbers from a plane of differences that begins at a byte.
std::vector<unsigned> plane(const std::vector<std::uint8_t>& bytes, std::size_t begin,
                            std::size_t count) {
  std::vector<unsigned> numbers(count);
  int last = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const int d = bytes[begin + i] + 256 * bytes[begin + count + i];
    last = (last + (d % 2 == 0 ? d / 2 : -(d + 1) / 2)) & 65535;
    numbers[i] = static_cast<unsigned>(last);
  }
  return numbers;
}

/// The 8-bit value of a color code, by the formula of the format's page.
int byte_of(unsigned code) {
  return code == 0 ? 0 : static_cast<int>(std::lround(std::exp2((int(code) - 1024) / 256.0)));
}

TEST(MapFormat, IsReadWithSqliteAndZstdAlone) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const TileMap map = sample_tile_map();
  const Raw raw(folder / "a.fovea");
  sqlite3_stmt* row = nullptr;
  ASSERT_EQ(sqlite3_prepare_v2(raw.database, "SELECT * FROM tiles", -1, &row, nullptr), SQLITE_OK);
  ASSERT_EQ(sqlite3_column_count(row), 26);
  std::size_t points = 0;
  while (sqlite3_step(row) == SQLITE_ROW) {
    const auto submap = static_cast<std::size_t>(sqlite3_column_int64(row, 0));
    const TileKey key = {sqlite3_column_int(row, 1), sqlite3_column_int(row, 2),
                         sqlite3_column_int(row, 3)};
    const PointCloud tile = map.submaps()[submap].tiles.at(key).points->cloud();
    const auto count = static_cast<std::size_t>(sqlite3_column_int64(row, 4));
    ASSERT_EQ(count, tile.size());
    points += count;
    EXPECT_EQ(sqlite3_column_double(row, 7), tile.origin.y());
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<unsigned> steps =
          plane(inflate<std::uint8_t>(row, 9, 6 * count), std::size_t(axis) * 2 * count, count);
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(static_cast<float>(steps[i]) * 0.001f, tile.position[i][axis]);
      }
    }
    const auto color = inflate<std::uint8_t>(row, 10, 6 * count);
    const std::vector<unsigned> green = plane(color, 0, count),
                                red = plane(color, 2 * count, count),
                                blue = plane(color, 4 * count, count);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(byte_of(green[i]), to_rgb(tile.color[i]).g);
      ASSERT_EQ(byte_of((green[i] + red[i]) % 65536), to_rgb(tile.color[i]).r);
      ASSERT_EQ(byte_of((green[i] + blue[i]) % 65536), to_rgb(tile.color[i]).b);
    }
    const std::vector<unsigned> range = plane(inflate<std::uint8_t>(row, 13, 2 * count), 0, count);
    const auto incidence = inflate<std::uint8_t>(row, 14, count);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(static_cast<float>(range[i]) * 0.01f, tile.range[i]);
      ASSERT_EQ(incidence[i] == 255, std::isnan(tile.incidence[i]));
      if (incidence[i] == 255) continue;
      ASSERT_NEAR(incidence[i] * std::numbers::pi / 360, tile.incidence[i], 1e-6);
    }
    EXPECT_TRUE(same_bits(inflate_runs<std::int8_t>(row, 11), tile.camera));
    EXPECT_TRUE(same_bits(inflate_runs<std::int32_t>(row, 12), tile.frame));
    EXPECT_TRUE(same_bits(inflate_runs<std::uint8_t>(row, 15), tile.interpolated));
    EXPECT_TRUE(same_bits(inflate<std::uint8_t>(row, 16, count), tile.views));
    EXPECT_TRUE(same_bits(inflate<std::uint8_t>(row, 17, count), tile.spread));
    EXPECT_TRUE(same_bits(inflate<std::uint16_t>(row, 18, count), tile.weight));
    EXPECT_TRUE(same_bits(inflate_runs<std::uint8_t>(row, 19), tile.reason));
    EXPECT_TRUE(same_bits(inflate_runs<float>(row, 20), tile.intensity));
    for (int column = 21; column < 25; ++column) {
      EXPECT_EQ(sqlite3_column_type(row, column), SQLITE_NULL);
    }
  }
  sqlite3_finalize(row);
  EXPECT_EQ(points, map.size());
}

/// Bytes of digests and checksums, as the format's page lists them.
struct DigestBytes {
  void add(const void* data, std::size_t size) {
    if (size == 0) return;
    bytes.resize(bytes.size() + size);
    std::memcpy(bytes.data() + bytes.size() - size, data, size);
  }
  void tag(char kind) { add(&kind, 1); }
  void number(char kind, auto value) {
    tag(kind);
    add(&value, sizeof(value));
  }
  void sized(char kind, const void* data, std::size_t size) {
    number(kind, static_cast<std::int64_t>(size));
    add(data, size);
  }
  /// A blob as it is stored.
  void stored_column(sqlite3_stmt* row, int column) {
    if (sqlite3_column_type(row, column) != SQLITE_BLOB) return this->column(row, column);
    sized('b', sqlite3_column_blob(row, column),
          static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
  }
  /// A blob decompressed.
  void column(sqlite3_stmt* row, int column) {
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, column));
    switch (sqlite3_column_type(row, column)) {
      case SQLITE_INTEGER:
        return number('i', sqlite3_column_int64(row, column));
      case SQLITE_FLOAT:
        return number('r', sqlite3_column_double(row, column));
      case SQLITE_TEXT:
        return sized('t', sqlite3_column_text(row, column), size);
      case SQLITE_NULL:
        return tag('n');
      default:
        break;
    }
    const void* blob = sqlite3_column_blob(row, column);
    const auto content = static_cast<std::size_t>(ZSTD_getFrameContentSize(blob, size));
    const auto values = inflate<char>(row, column, content);
    sized('b', values.data(), content);
  }
  void table(sqlite3* database, const std::string& name, const std::string& query) {
    tag('S');
    sized('t', name.data(), name.size());
    sqlite3_stmt* row = nullptr;
    ASSERT_EQ(sqlite3_prepare_v2(database, query.c_str(), -1, &row, nullptr), SQLITE_OK);
    while (sqlite3_step(row) == SQLITE_ROW) {
      tag('R');
      for (int i = 0; i < sqlite3_column_count(row); ++i) column(row, i);
    }
    sqlite3_finalize(row);
  }
  std::vector<char> bytes;
};

TEST(MapFormat, DigestIsAsStated) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const Raw raw(folder / "a.fovea");
  DigestBytes digest;
  digest.table(raw.database, "meta",
               "SELECT key, value FROM meta "
               "WHERE key NOT LIKE 'timing.%' AND key <> 'format_version' ORDER BY key");
  digest.table(raw.database, "drives",
               "SELECT id, name, kind, session, calibration_fingerprint, stamps_fingerprint, "
               "first_frame, end_frame, frame_shift, pose, origin_latitude_deg, "
               "origin_longitude_deg, origin_height_m, datum, epoch_year, height_type, "
               "source_digest FROM drives ORDER BY id");
  digest.table(raw.database, "sensors",
               "SELECT id, drive, name, pose, profile FROM sensors ORDER BY id");
  digest.table(raw.database, "frames",
               "SELECT frame, stamp_ns, status, note, pose, navigation_pose, odometry_pose, "
               "submap, revisited_submap, revisited_pose, motion, figures "
               "FROM frames ORDER BY frame");
  digest.table(raw.database, "views",
               "SELECT frame, camera, stamp_ns, log2_gain_red, log2_gain_green, log2_gain_blue, "
               "log2_color, response, revisit FROM views ORDER BY frame, camera");
  digest.table(raw.database, "submaps",
               "SELECT id, drive, pose, covariance, log2_gain FROM submaps ORDER BY id");
  digest.table(raw.database, "keyframes",
               "SELECT frame, sensor, elevations_rad, columns, first_azimuth_rad, "
               "azimuth_step_rad, range_cm FROM keyframes ORDER BY frame, sensor");
  digest.table(raw.database, "tiles",
               "SELECT submap, x, y, z, points, origin_x_m, origin_y_m, origin_z_m, position_mm, "
               "color, camera, frame, range_cm, incidence_half_deg, interpolated, views, spread, "
               "weight, reason, intensity, saturated, sensor, sampling_level, session "
               "FROM tiles ORDER BY submap, x, y, z");
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(digest.bytes.data(), digest.bytes.size()));
  std::string hex;
  for (const unsigned char byte : canonical.digest) hex += fmt::format("{:02x}", byte);
  EXPECT_EQ(MapReader(folder / "a.fovea").digest(), hex);
}

TEST(MapFormat, ChecksumsAreAsStated) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const Raw raw(folder / "a.fovea");
  for (const Table* table : kTables) {
    const std::string name = table->name;
    sqlite3_stmt* row = nullptr;
    const std::string query = "SELECT * FROM " + name;
    ASSERT_EQ(sqlite3_prepare_v2(raw.database, query.c_str(), -1, &row, nullptr), SQLITE_OK);
    const int last = sqlite3_column_count(row) - 1;
    EXPECT_STREQ(sqlite3_column_name(row, last), "checksum");
    int rows_of_table = 0;
    for (; sqlite3_step(row) == SQLITE_ROW; ++rows_of_table) {
      DigestBytes bytes;
      bytes.tag('S');
      bytes.sized('t', name.data(), name.size());
      for (int i = 0; i < last; ++i) bytes.stored_column(row, i);
      EXPECT_EQ(static_cast<std::uint64_t>(sqlite3_column_int64(row, last)),
                XXH3_64bits(bytes.bytes.data(), bytes.bytes.size()))
          << name << ' ' << rows_of_table;
    }
    sqlite3_finalize(row);
    EXPECT_GT(rows_of_table, 0) << name;
  }
}

// One list of columns and keys in code, and the page states each.
TEST(MapFormat, ThePageStatesEveryColumnAndKey) {
  std::ifstream file(FOVEA_SOURCE_DIR "/docs/map-format.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  for (const Table* table : kTables) {
    const auto begin = page.find(fmt::format("CREATE TABLE {}(", table->name));
    ASSERT_NE(begin, std::string::npos) << table->name;
    const auto key = page.find("PRIMARY KEY(", begin);
    const std::string statement = page.substr(begin, page.find('\n', key) - begin);
    std::size_t at = 0;
    for (const Column& column : table->columns) {
      at = statement.find(fmt::format("\n  {} {},", column.name, column.type), at);
      ASSERT_NE(at, std::string::npos) << table->name << '.' << column.name;
    }
    EXPECT_NE(statement.find(fmt::format("PRIMARY KEY({})", table->key)), std::string::npos);
  }
  for (const std::string_view key : meta_key::kAll) {
    EXPECT_NE(page.find(fmt::format("`{}", key)), std::string::npos) << key;
  }
}

}  // namespace fovea::map_format_test
