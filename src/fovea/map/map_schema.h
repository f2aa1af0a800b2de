// The schema of a map file (docs/map-format.md). Private to map/.
#pragma once

#include "fovea/map/map_store.h"

namespace fovea {

/// "FVEA": how a map is told from other SQLite files.
inline constexpr int kMapApplicationId = 0x46564541;
/// Meta keys with this prefix are left out of the digest.
inline constexpr const char* kTimingPrefix = "timing.";

inline constexpr const char* kCreateTables = R"(
CREATE TABLE meta(
  key TEXT PRIMARY KEY NOT NULL,
  value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE frames(
  idx INTEGER PRIMARY KEY,
  stamp_ns INTEGER,
  status TEXT NOT NULL,
  note TEXT NOT NULL,
  pose TEXT NOT NULL,
  navigation_pose TEXT,
  odom_pose TEXT NOT NULL,
  submap INTEGER NOT NULL,
  revisited INTEGER,
  revisited_pose TEXT,
  velocity TEXT,
  figures TEXT NOT NULL,
  timings TEXT NOT NULL);
CREATE TABLE submaps(
  id INTEGER PRIMARY KEY,
  pose TEXT NOT NULL);
CREATE TABLE tiles(
  submap INTEGER NOT NULL,
  x INTEGER NOT NULL,
  y INTEGER NOT NULL,
  z INTEGER NOT NULL,
  points INTEGER NOT NULL,
  colored INTEGER NOT NULL,
  origin_x REAL NOT NULL,
  origin_y REAL NOT NULL,
  origin_z REAL NOT NULL,
  position BLOB NOT NULL,
  color BLOB NOT NULL,
  camera BLOB NOT NULL,
  frame BLOB NOT NULL,
  range BLOB NOT NULL,
  incidence BLOB NOT NULL,
  interpolated BLOB NOT NULL,
  views BLOB NOT NULL,
  spread BLOB NOT NULL,
  weight BLOB NOT NULL,
  reason BLOB NOT NULL,
  intensity BLOB,
  checksum INTEGER NOT NULL,
  PRIMARY KEY(submap, x, y, z));
)";

}  // namespace fovea
