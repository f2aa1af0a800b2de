// The map file: one SQLite database (docs/map-format.md). The only place that knows its schema.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/tile_map.h"

namespace fovea {

/// Version of the schema; a file of another version is refused.
inline constexpr int kMapSchemaVersion = 4;

using MapMeta = std::map<std::string, std::string>;

/// Writes a map. Everything put between two commits is on disk together or not at all; what was
/// never committed leaves no file behind. An error ends the writing: only destruction may follow.
class MapWriter {
 public:
  /// Starts a new map. OutputError if `path` exists and `force` is false, its folder does not exist
  /// or nothing can be written there. The file appears under its name at the first commit.
  static std::unique_ptr<MapWriter> create(const std::filesystem::path& path, bool force);
  /// Opens an existing map to go on with it. InputError as MapReader, OutputError if it cannot be
  /// written or another program is writing it.
  static std::unique_ptr<MapWriter> open(const std::filesystem::path& path);

  /// Drops what was not committed.
  virtual ~MapWriter() = default;
  /// Each put replaces what the map has under the same key.
  virtual void put_meta(const std::string& key, const std::string& value) = 0;
  /// std::invalid_argument if a pose or velocity is not finite.
  virtual void put_frame(const FrameRecord& record) = 0;
  virtual void put_submap(std::size_t id, const RigidMotion& T_local_submap) = 0;
  /// std::logic_error if the tile lacks a column (see Submap::tiles).
  virtual void put_tile(std::size_t submap, const TileKey& key, const PointCloud& tile) = 0;
  /// OutputError when the disk is full or the file cannot be written.
  virtual void commit() = 0;
};

/// Reads a map, tile by tile. Every method gives one committed state, also while the map is being
/// written, and throws InputError where the file is damaged.
class MapReader {
 public:
  /// InputError if the file is missing, is not a Fovea map, or has another schema version.
  explicit MapReader(const std::filesystem::path& path);
  ~MapReader();
  MapReader(MapReader&&) noexcept;

  MapMeta meta() const;
  std::vector<FrameRecord> frames() const;   ///< by index
  std::vector<RigidMotion> submaps() const;  ///< T_local_submap by id
  std::size_t size() const;                  ///< number of points
  std::size_t colored_size() const;          ///< number of those that a camera has coloured
  /// Calls f(submap, key, tile) in the order of submap and key; positions as in Submap::tiles.
  void for_each_tile(
      const std::function<void(std::size_t, const TileKey&, const PointCloud&)>& f) const;
  /// All points in the local frame, origin at 0.
  PointCloud all_points_local() const;
  /// Hash of everything but timings, rows in key order: 32 hexadecimal digits (XXH3, 128 bits).
  std::string digest() const;

 private:
  struct Database;
  std::unique_ptr<Database> database_;
};

}  // namespace fovea
