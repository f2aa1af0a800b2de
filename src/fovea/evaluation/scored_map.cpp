#include "fovea/evaluation/scored_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/point_files/cloud_format.h"
#include "fovea/map/point_files/las_reader.h"
#include "fovea/pipeline/config.h"

namespace fovea {
namespace {

/// A point near all poses, in whole metres: floats relative to it are precise wherever `local`
/// lies.
Eigen::Vector3d center_of(const std::vector<FrameRecord>& frames) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const FrameRecord& record : frames) sum += record.T_local_lidar.translation();
  if (!frames.empty()) sum /= static_cast<double>(frames.size());
  return sum.array().round();
}

std::vector<int> cameras_of(const PointCloud& points) {
  std::set<int> cameras;
  for (const std::int8_t camera : points.camera) {
    if (camera != kNoCamera) cameras.insert(camera);
  }
  return {cameras.begin(), cameras.end()};
}

/// Gives points without color their intensity as gray, for pictures. Scores of colors leave these
/// points out.
void show_intensity(const PointCloud& tile, std::vector<LogColor>& color) {
  for (std::size_t i = 0; i < tile.size(); ++i) {
    if (tile.camera[i] == kNoCamera) {
      color[i] = to_rgb(Eigen::Vector3f::Constant(255 * std::clamp(tile.intensity[i], 0.0f, 1.0f)));
    }
  }
}

/// Records without stamp and of no particular status, one a pose.
std::vector<FrameRecord> pose_records(const std::filesystem::path& file, int first_frame) {
  std::vector<FrameRecord> records;
  for (const RigidMotion& pose : read_poses(file)) {
    FrameRecord record;
    record.index = first_frame + static_cast<int>(records.size());
    record.T_local_lidar = pose;
    records.push_back(record);
  }
  return records;
}

ScoredMap load_cloud(const std::filesystem::path& path, CloudFormat format,
                     const ScoredMapOptions& options) {
  if (format == CloudFormat::kLaz) reject_laz(path);  // whatever else is missing
  if (!options.poses) {
    throw ConfigError("a point cloud has no poses", path.string(),
                      "give --poses FILE, one T_local_lidar a line");
  }
  ScoredMap map;
  map.statuses_known = false;
  map.frames = pose_records(*options.poses, options.first_frame);
  CloudFile cloud = read_cloud(path, format, center_of(map.frames));
  map.points_local = std::move(cloud.points);
  if (cloud.has_camera) map.cameras = cameras_of(map.points_local);
  return map;
}

}  // namespace

ScoredMap load_scored_map(const std::filesystem::path& path, const ScoredMapOptions& options) {
  if (const auto format = cloud_format(path)) return load_cloud(path, *format, options);
  if (options.poses) {
    throw ConfigError("a Fovea map has poses of its own", path.string(), "leave out --poses");
  }
  return load_scored_map(MapReader(path));
}

ScoredMap load_scored_map(const MapReader& reader) {
  ScoredMap map;
  map.frames = reader.frames();
  map.meta = reader.meta();
  begin_points(map, reader.size());
  const std::vector<RigidMotion> submaps = reader.submaps();
  reader.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    append_points(scored_columns(tile), submaps.at(submap), map);
  });
  finish_points(map);
  return map;
}

void begin_points(ScoredMap& map, std::size_t points) {
  map.points_local.origin = center_of(map.frames);
  map.points_local.position.reserve(points);
  map.points_local.color.reserve(points);
  map.points_local.camera.reserve(points);
  map.points_local.frame.reserve(points);
  map.points_local.interpolated.reserve(points);
  map.points_local.reason.reserve(points);
  map.points_local.sampling_level.reserve(points);
}

PointCloud scored_columns(const PointCloud& tile) {
  PointCloud part;
  part.origin = tile.origin;
  part.position = tile.position;
  part.color = tile.color;
  if (!tile.intensity.empty()) show_intensity(tile, part.color);
  part.camera = tile.camera;
  part.frame = tile.frame;
  part.interpolated = tile.interpolated;
  part.reason = tile.reason;
  part.sampling_level = tile.sampling_level;
  return part;
}

void append_points(PointCloud points, const RigidMotion& T_local_points, ScoredMap& map) {
  map.points_local.append(
      transform_cloud(std::move(points), T_local_points, map.points_local.origin));
}

void finish_points(ScoredMap& map) { map.cameras = cameras_of(map.points_local); }

std::vector<float> spacing_of(const ColoredPoints& points, const MapMeta& meta) {
  const auto config = meta.find(meta_key::kConfig);
  if (config == meta.end()) return sample_spacing(points.position);
  const double cell = stored_settings(config->second, "the map").spacing();
  return cell > 0 ? sample_spacing(points, cell) : sample_spacing(points.position);
}

void choose_frames(const std::map<int, int>& number_in_drive, ScoredMap& map) {
  std::map<int, FrameRecord> chosen;
  for (const FrameRecord& record : map.frames) {
    const auto number = number_in_drive.find(record.index);
    if (number == number_in_drive.end()) continue;
    FrameRecord renumbered = record;
    renumbered.index = number->second;
    const auto [place, is_new] = chosen.try_emplace(renumbered.index, renumbered);
    if (!is_new && record.status == FrameStatus::kMapped) place->second.status = record.status;
  }
  map.frames.clear();
  for (auto& [number, record] : chosen) map.frames.push_back(std::move(record));
  for (std::int32_t& frame : map.points_local.frame) {
    const auto number = number_in_drive.find(frame);
    frame = number == number_in_drive.end() ? -1 : number->second;
  }
}

}  // namespace fovea
