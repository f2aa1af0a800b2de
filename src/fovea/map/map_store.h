// The map file: one SQLite database (docs/map-format.md). The only place that knows its schema.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/map/map_records.h"
#include "fovea/map/packed_tile.h"
#include "fovea/map/point_filter.h"
#include "fovea/map/tile_map.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Version of the format that is written.
inline constexpr int kMapFormatVersion = 7;

/// What to do about a map that is damaged.
inline constexpr const char* kRestoreMap =
    "restore the map from a copy, or save what is whole with 'fovea repair'";

using MapMeta = std::map<std::string, std::string>;

class MapFile;

/// How long the last commit waits for a program that keeps an earlier state of the map open: longer
/// than a reader of tiles does, shorter than what a user takes for a hang.
inline constexpr std::chrono::seconds kReaderTimeout{10};

/// Writes a map. Everything put between two commits is on disk together or not at all; what was
/// never committed leaves no file behind. An error ends the writing: only destruction may follow.
class MapWriter {
 public:
  /// Starts a new map. OutputError if `path` exists and `force` is false, its folder does not exist
  /// or nothing can be written there. The file appears under its name at the first commit.
  /// @param scratch  a folder of this machine, for a map in a shared folder; empty: none. The map
  ///                 grows there without a write-ahead log. Commits before the end do nothing. The
  ///                 end copies it next to `path`, makes the copy durable and read-only, and
  ///                 renames it. OutputError if it is no folder.
  static std::unique_ptr<MapWriter> create(const std::filesystem::path& path, bool force,
                                           const std::filesystem::path& scratch = {});
  /// Opens an existing map to extend it. InputError as MapReader, and for a map of an older format;
  /// OutputError if it cannot be written or another program is writing it.
  static std::unique_ptr<MapWriter> open(const std::filesystem::path& path);

  /// Drops what was not committed.
  virtual ~MapWriter() = default;
  /// Each put replaces what the map has under the same key.
  virtual void put_meta(const std::string& key, const std::string& value) = 0;
  // The puts of records: std::invalid_argument if a number is not finite.
  virtual void put_drive(std::size_t id, const DriveRecord& drive) = 0;
  virtual void put_sensor(std::size_t id, const SensorRecord& sensor) = 0;
  /// With its views, which replace all that the map has of the frame.
  virtual void put_frame(const FrameRecord& record) = 0;
  virtual void put_submap(std::size_t id, const SubmapRecord& submap) = 0;
  void put_submap(std::size_t id, const RigidMotion& T_local_submap) {
    SubmapRecord submap;
    submap.T_local_submap = T_local_submap;
    put_submap(id, submap);
  }
  /// Changes the pose of a frame; nothing if the map does not have the frame. InputError if the
  /// frame is damaged.
  virtual void put_pose(int frame, const RigidMotion& T_local_lidar) = 0;
  /// std::invalid_argument also if rows times columns is not the number of ranges.
  virtual void put_keyframe(const KeyframeRecord& keyframe) = 0;
  /// State for resuming, under a name. It is not part of the digest.
  virtual void put_checkpoint(const std::string& name, const CheckpointRecord& checkpoint) = 0;
  virtual void put_tile(const PackedTile& tile) = 0;
  /// Puts `tile(i)` for each i of [0, count), packed and compressed by all threads there are.
  virtual void put_tiles(std::size_t count, const std::function<PackedTile(std::size_t)>& tile) = 0;
  void put_tile(const TileId& id, const TilePoints& tile) { put_tile(pack_tile(id, tile)); }
  /// std::logic_error as TilePoints::of().
  void put_tile(const TileId& id, const PointCloud& tile) { put_tile(id, TilePoints::of(tile)); }
  virtual void remove_tile(const TileId& id) = 0;
  /// A tile as it was put, committed or not; InputError if it is not there or damaged.
  virtual TilePoints read_tile(const TileId& id) = 0;
  /// OutputError when the disk is full or the file cannot be written.
  virtual void commit() = 0;
  /// The last commit. Afterwards the file alone is the whole map, also while others read it; only
  /// destruction may follow. OutputError as commit(), or if the write-ahead log cannot be merged
  /// into the file: the disk is full, or another program keeps an earlier state open for longer
  /// than `reader_timeout`.
  virtual void finish(std::chrono::milliseconds reader_timeout) = 0;
  void finish() { finish(kReaderTimeout); }
};

/// Reads a map, tile by tile. Every method gives one committed state, also while the map is being
/// written, and throws InputError where the file is damaged: each row has a checksum.
class MapReader {
 public:
  /// Reads maps of formats 6 and 7. InputError if the file is missing, is not a Fovea map, or has
  /// another format.
  explicit MapReader(const std::filesystem::path& path);
  /// Reads what is whole of a file that may be damaged. Each row that cannot be read is reported in
  /// one line and left out. A submap that cannot be read gets the pose of its first frame; without
  /// one, its tiles are left out, too. Rows that the file has
  /// out of order come out of order. InputError if the file is no map.
  MapReader(const std::filesystem::path& path,
            std::function<void(const std::string& damage)> on_damage);
  ~MapReader();
  MapReader(MapReader&&) noexcept;

  /// While the result lives, all methods give the same committed state; this reader outlives it.
  [[nodiscard]] std::shared_ptr<const void> hold_state() const;

  int format_version() const;
  MapMeta meta() const;
  std::vector<DriveRecord> drives() const;    ///< by number
  std::vector<SensorRecord> sensors() const;  ///< by number
  std::vector<FrameRecord> frames() const;    ///< by index
  /// As the file has them: gains are relative to the frame's submap.
  std::vector<FrameRecord> stored_frames() const;
  std::vector<RigidMotion> submaps() const;  ///< T_local_submap by id
  /// By id, without gains: the tiles that this reader returns have the exposure of the map.
  std::vector<SubmapRecord> submap_records() const;
  /// Calls f(keyframe) in the order of frames and sensors.
  void for_each_keyframe(const std::function<void(const KeyframeRecord&)>& f) const;
  /// Nothing if there is no state under that name.
  std::optional<CheckpointRecord> checkpoint(const std::string& name) const;
  std::size_t size() const;          ///< number of points
  std::size_t colored_size() const;  ///< number of those that a camera has coloured
  /// The tiles that there are, in the order of submap and key, and how many points each has.
  std::vector<std::pair<TileId, std::size_t>> tile_sizes() const;
  /// Submap frame, relative to the cloud's `origin` = the tile's lowest corner; InputError if the
  /// tile is not there or damaged.
  PointCloud read_tile(const TileId& id) const;
  /// Nothing if the tile is not there; InputError if it is damaged.
  std::optional<TilePoints> find_tile(const TileId& id) const;
  /// Calls f(submap, key, tile) in the order of submap and key.
  void for_each_tile(
      const std::function<void(std::size_t, const TileKey&, const PointCloud&)>& f) const;
  /// As for_each_tile(), with all columns that the file has.
  void for_each_stored_tile(const std::function<void(const TileId&, const TilePoints&)>& f) const;
  /// All points that pass, in the local frame, origin at 0.
  PointCloud all_points_local(const PointFilter& where = {}) const;
  /// Hash of everything but timings, rows in key order: 32 hexadecimal digits (XXH3, 128 bits).
  std::string digest() const;
  /// Names the map for files about it. Unlike digest(), it depends on how tiles are compressed, and
  /// it takes no time that counts: 32 hexadecimal digits.
  std::string identity() const;
  /// Has SQLite check pages, indexes and free pages.
  void check_structure() const;
  /// Reads every row but those of tiles.
  void check_records() const;
  /// Both, and reads every tile.
  /// @return the number of tiles
  std::size_t check() const;

 private:
  Eigen::Vector3d submap_gain(std::size_t submap) const;

  std::unique_ptr<MapFile> file_;
};

/// Merges the log that a writer left next to a map, if no program uses the map. Nothing else, and
/// no error, if that is not possible.
void fold_log(const std::filesystem::path& path);

/// The log that belongs to a map: MAP-wal, if it has content. Empty: the file is the whole map.
std::filesystem::path log_of_map(const std::filesystem::path& path);

/// What to do with a log, for errors: "keep MAP-wal with the map, it is part of it; ...".
std::string log_remedy(const std::filesystem::path& map);

/// Puts all that a map has but its tiles and checkpoints: no run can resume a copy.
/// @return T_local_submap by id
std::vector<RigidMotion> copy_all_but_tiles(const MapReader& map, MapWriter& output);

}  // namespace fovea
