// The tables and columns of a map file (docs/map-format.md): their one list. Private to map/.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace fovea {

/// "FVEA": marks a map among other SQLite files.
inline constexpr int kMapApplicationId = 0x46564541;

/// Bytes. Larger than SQLite's default: a tile's columns are tens of kilobytes each.
inline constexpr std::size_t kPageSize = 8192;

struct Column {
  const char* name;
  const char* type;
  bool in_digest = true;
};

/// Every table has one more column, `checksum`, its last: row_checksum() of the others.
struct Table {
  const char* name;
  const char* key;  ///< columns of the primary key, comma separated
  std::span<const Column> columns;
  bool has_rowid = true;  ///< false for tables of small rows: one tree in place of two

  std::size_t column_count() const { return columns.size(); }
};

inline constexpr Column kMetaColumns[] = {{"key", "TEXT NOT NULL"}, {"value", "TEXT NOT NULL"}};

inline constexpr Column kDriveColumns[] = {
    {"id", "INTEGER"},
    {"name", "TEXT NOT NULL"},
    {"kind", "TEXT NOT NULL"},
    {"session", "TEXT"},
    {"calibration_fingerprint", "TEXT"},
    {"stamps_fingerprint", "TEXT"},
    {"first_frame", "INTEGER NOT NULL"},
    {"end_frame", "INTEGER NOT NULL"},
    {"frame_shift", "INTEGER NOT NULL"},
    {"pose", "TEXT NOT NULL"},
    {"origin_latitude_deg", "REAL"},
    {"origin_longitude_deg", "REAL"},
    {"origin_height_m", "REAL"},
    {"datum", "TEXT"},
    {"epoch_year", "REAL"},
    {"height_type", "TEXT"},
    {"source_digest", "TEXT"},
};

inline constexpr Column kSensorColumns[] = {
    {"id", "INTEGER"},         {"drive", "INTEGER NOT NULL"}, {"name", "TEXT NOT NULL"},
    {"pose", "TEXT NOT NULL"}, {"profile", "TEXT NOT NULL"},
};

inline constexpr Column kFrameColumns[] = {
    {"frame", "INTEGER"},
    {"stamp_ns", "INTEGER"},
    {"status", "TEXT NOT NULL"},
    {"note", "TEXT NOT NULL"},
    {"pose", "TEXT NOT NULL"},
    {"navigation_pose", "TEXT"},
    {"odometry_pose", "TEXT NOT NULL"},
    {"submap", "INTEGER NOT NULL"},
    {"revisited_submap", "INTEGER"},
    {"revisited_pose", "TEXT"},
    {"motion", "TEXT"},
    {"figures", "TEXT NOT NULL"},
    {"timings_ms", "TEXT NOT NULL", /*in_digest=*/false},
};

inline constexpr Column kViewColumns[] = {
    {"frame", "INTEGER NOT NULL"}, {"camera", "INTEGER NOT NULL"}, {"stamp_ns", "INTEGER"},
    {"log2_gain_red", "REAL"},     {"log2_gain_green", "REAL"},    {"log2_gain_blue", "REAL"},
    {"log2_color", "TEXT"},        {"response", "TEXT"},           {"revisit", "TEXT"},
};

inline constexpr Column kSubmapColumns[] = {
    {"id", "INTEGER"},      {"drive", "INTEGER NOT NULL"}, {"pose", "TEXT NOT NULL"},
    {"covariance", "TEXT"}, {"log2_gain", "TEXT"},
};

inline constexpr Column kKeyframeColumns[] = {
    {"frame", "INTEGER NOT NULL"},          {"sensor", "INTEGER NOT NULL"},
    {"elevations_rad", "TEXT NOT NULL"},    {"columns", "INTEGER NOT NULL"},
    {"first_azimuth_rad", "REAL NOT NULL"}, {"azimuth_step_rad", "REAL NOT NULL"},
    {"range_cm", "BLOB NOT NULL"},
};

/// The columns of points begin at kFirstPointColumn, in the order of for_each_stored_column().
inline constexpr Column kTileColumns[] = {
    {"submap", "INTEGER NOT NULL"},
    {"x", "INTEGER NOT NULL"},
    {"y", "INTEGER NOT NULL"},
    {"z", "INTEGER NOT NULL"},
    {"points", "INTEGER NOT NULL"},
    {"colored", "INTEGER NOT NULL", /*in_digest=*/false},
    {"origin_x_m", "REAL NOT NULL"},
    {"origin_y_m", "REAL NOT NULL"},
    {"origin_z_m", "REAL NOT NULL"},
    {"position_mm", "BLOB NOT NULL"},
    {"color", "BLOB NOT NULL"},
    {"camera", "BLOB NOT NULL"},
    {"frame", "BLOB NOT NULL"},
    {"range_cm", "BLOB NOT NULL"},
    {"incidence_half_deg", "BLOB NOT NULL"},
    {"interpolated", "BLOB NOT NULL"},
    {"views", "BLOB NOT NULL"},
    {"spread", "BLOB NOT NULL"},
    {"weight", "BLOB NOT NULL"},
    {"reason", "BLOB NOT NULL"},
    {"intensity", "BLOB"},
    {"saturated", "BLOB"},
    {"sensor", "BLOB"},
    {"sampling_level", "BLOB"},
    {"session", "BLOB"},
};
inline constexpr std::size_t kFirstPointColumn = 9;

inline constexpr Column kCheckpointColumns[] = {
    {"name", "TEXT NOT NULL"},
    {"frame", "INTEGER NOT NULL"},
    {"state", "BLOB NOT NULL"},
};

inline constexpr Column kCountColumns[] = {
    {"table_name", "TEXT NOT NULL"},
    {"row_count", "INTEGER NOT NULL"},
};

inline constexpr Table kMetaTable{"meta", "key", kMetaColumns, /*has_rowid=*/false};
inline constexpr Table kDrivesTable{"drives", "id", kDriveColumns};
inline constexpr Table kSensorsTable{"sensors", "id", kSensorColumns};
inline constexpr Table kFramesTable{"frames", "frame", kFrameColumns};
inline constexpr Table kViewsTable{"views", "frame, camera", kViewColumns, false};
inline constexpr Table kSubmapsTable{"submaps", "id", kSubmapColumns};
inline constexpr Table kKeyframesTable{"keyframes", "frame, sensor", kKeyframeColumns};
inline constexpr Table kTilesTable{"tiles", "submap, x, y, z", kTileColumns};
inline constexpr Table kCheckpointTable{"checkpoint", "name", kCheckpointColumns};
inline constexpr Table kCountsTable{"counts", "table_name", kCountColumns, false};

/// The first eight make up the digest, in this order.
inline constexpr std::array<const Table*, 10> kTables = {
    &kMetaTable,    &kDrivesTable,    &kSensorsTable, &kFramesTable,     &kViewsTable,
    &kSubmapsTable, &kKeyframesTable, &kTilesTable,   &kCheckpointTable, &kCountsTable,
};

/// "CREATE TABLE ...;"
std::string create_sql(const Table& table);
/// "SELECT all columns, checksum FROM table".
std::string select_sql(const Table& table);
/// "INSERT OR REPLACE INTO table VALUES(?1, ...)".
std::string insert_sql(const Table& table);

}  // namespace fovea
