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
#include <numbers>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/map/map_store.h"
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

TEST(MapFormat, IsReadWithSqliteAndZstdAlone) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const TileMap map = sample_tile_map();
  const Raw raw(folder / "a.fovea");
  sqlite3_stmt* row = nullptr;
  ASSERT_EQ(sqlite3_prepare_v2(raw.database, "SELECT * FROM tiles", -1, &row, nullptr), SQLITE_OK);
  ASSERT_EQ(sqlite3_column_count(row), 22);
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
    const std::vector<unsigned> range = plane(inflate<std::uint8_t>(row, 13, 2 * count), 0, count);
    const auto incidence = inflate<std::uint8_t>(row, 14, count);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(static_cast<float>(range[i]) * 0.01f, tile.range[i]);
      ASSERT_EQ(incidence[i] == 255, std::isnan(tile.incidence[i]));
      if (incidence[i] == 255) continue;
      ASSERT_NEAR(incidence[i] * std::numbers::pi / 360, tile.incidence[i], 1e-6);
    }
    const auto color = inflate<std::uint8_t>(row, 10, 3 * count);
    EXPECT_EQ(color[1], tile.color[0].g);
    EXPECT_TRUE(same_bits(inflate_runs<std::int8_t>(row, 11), tile.camera));
    EXPECT_TRUE(same_bits(inflate_runs<std::int32_t>(row, 12), tile.frame));
    EXPECT_TRUE(same_bits(inflate_runs<std::uint8_t>(row, 15), tile.interpolated));
    EXPECT_TRUE(same_bits(inflate<std::uint8_t>(row, 16, count), tile.views));
    EXPECT_TRUE(same_bits(inflate<std::uint8_t>(row, 17, count), tile.spread));
    EXPECT_TRUE(same_bits(inflate<std::uint16_t>(row, 18, count), tile.weight));
    EXPECT_TRUE(same_bits(inflate_runs<std::uint8_t>(row, 19), tile.reason));
    EXPECT_TRUE(same_bits(inflate_runs<float>(row, 20), tile.intensity));

    std::vector<char> bytes;
    const auto add_bytes = [&](const void* data, std::size_t size) {
      bytes.resize(bytes.size() + size);
      std::memcpy(bytes.data() + bytes.size() - size, data, size);
    };
    const auto add = [&](auto value) { add_bytes(&value, sizeof(value)); };
    for (int column = 0; column < 6; ++column) add(sqlite3_column_int64(row, column));
    for (int column = 6; column < 9; ++column) add(sqlite3_column_double(row, column));
    for (int column = 9; column < 21; ++column) {
      const int size = sqlite3_column_bytes(row, column);
      add(std::int64_t{size});
      add_bytes(sqlite3_column_blob(row, column), static_cast<std::size_t>(size));
    }
    EXPECT_EQ(static_cast<std::uint64_t>(sqlite3_column_int64(row, 21)),
              XXH3_64bits(bytes.data(), bytes.size()));
  }
  sqlite3_finalize(row);
  EXPECT_EQ(points, map.size());
}

/// Bytes of the digest, as the format's page lists them.
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
               "SELECT key, value FROM meta WHERE key NOT LIKE 'timing.%' ORDER BY key");
  digest.table(raw.database, "frames",
               "SELECT idx, stamp_ns, status, note, pose, navigation_pose, odom_pose, submap, "
               "revisited, revisited_pose, velocity, figures "
               "FROM frames ORDER BY idx");
  digest.table(raw.database, "submaps", "SELECT id, pose FROM submaps ORDER BY id");
  digest.table(
      raw.database, "tiles",
      "SELECT submap, x, y, z, points, origin_x, origin_y, origin_z, position, color, "
      "camera, frame, range, incidence, interpolated, views, spread, weight, reason, intensity "
      "FROM tiles ORDER BY submap, x, y, z");
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(digest.bytes.data(), digest.bytes.size()));
  std::string hex;
  for (const unsigned char byte : canonical.digest) hex += fmt::format("{:02x}", byte);
  EXPECT_EQ(MapReader(folder / "a.fovea").digest(), hex);
}

}  // namespace fovea::map_format_test
