// What is scored: a map's points, and the poses under which a drive's scans are placed in it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/map/colored_points.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/map_store.h"
#include "fovea/point_cloud.h"

namespace fovea {

struct ScoredMap {
  /// Local frame, relative to any origin near the drive; columns color and camera always, frame,
  /// interpolated, reason and sampling level where known.
  PointCloud points_local;
  std::vector<FrameRecord> frames;  ///< by index
  MapMeta meta;                     ///< empty for a cloud
  /// Whether `frames` says which frames were mapped and which held out; a cloud's poses do not.
  bool statuses_known = true;
  std::vector<int> cameras;  ///< that coloured the points, increasing; empty where unknown
};

struct ScoredMapOptions {
  /// T_local_lidar, 12 numbers a line (3x4, row-major); needed for a cloud, and for a cloud only.
  std::optional<std::filesystem::path> poses;
  int first_frame = 0;  ///< frame index of the first line of `poses`
};

/// Loads a Fovea map, or a coloured cloud (PLY, PCD, LAS) with its poses, told apart by the file's
/// ending. InputError if a file is missing, damaged or of a format that is not read (LAZ);
/// ConfigError for poses that are missing or not wanted.
ScoredMap load_scored_map(const std::filesystem::path& path, const ScoredMapOptions& options);
/// The same of a map that is open.
ScoredMap load_scored_map(const MapReader& reader);

// Steps of loading, also for a city (scored_city.h).

/// Puts the origin of the points near the frames.
/// @param points  how many append_points() will add: vectors that grow take twice the memory
void begin_points(ScoredMap& map, std::size_t points);
/// The columns of a tile that are scored. Points without color get their intensity as gray.
PointCloud scored_columns(const PointCloud& tile);
/// @param T_local_points  from the frame of the points to the local frame
void append_points(PointCloud points, const RigidMotion& T_local_points, ScoredMap& map);
/// Finds out which cameras colored the points.
void finish_points(ScoredMap& map);

/// Distance between neighboring samples around each point, m (sample_spacing). If the settings of
/// the map are known, by its cells.
std::vector<float> spacing_of(const ColoredPoints& points, const MapMeta& meta);

/// Leaves the frames of one drive, under their numbers in the drive. Points of other frames then
/// are of frame -1. If a merged map has a frame twice, it counts as mapped if either is mapped.
void choose_frames(const std::map<int, int>& number_in_drive, ScoredMap& map);

}  // namespace fovea
