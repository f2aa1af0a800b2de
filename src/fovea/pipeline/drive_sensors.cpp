#include "fovea/pipeline/drive_sensors.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "fovea/drive/scans/sensor_scans.h"
#include "fovea/mapping/range_image.h"
#include "fovea/mapping/sensor_profile_estimate.h"

namespace fovea {
namespace {

SensorProfile first_lidar(const DriveInfo& drive) {
  return drive.lidars.empty() ? SensorProfile() : drive.lidars.front().profile;
}

/// Surfaces must close between rings up to this range: the end of the white zone.
constexpr double kRange = 15;  // m

}  // namespace

double lidar_height(const DriveInfo& drive) {
  return first_lidar(drive).height.value_or(kUsualSensorHeight);
}

double row_height_of(const SensorProfile& profile) {
  // A margin: motion compensation scatters the elevations of a ring.
  const double spacing = ring_spacing_at(profile, elevation_on_ground(profile, kRange));
  return std::max(RangeImage::kLeastRowHeight, 1.1 * spacing);
}

std::vector<MountedLidar> mounted_lidars(const FrameSource& source) {
  constexpr std::size_t kScans = 2;
  constexpr int kMostFrames = 20;  // a further LiDAR may begin later
  const DriveInfo& drive = source.info();
  std::vector<MountedLidar> lidars = drive.lidars;
  if (lidars.empty()) lidars.emplace_back().profile.sweep = drive.sweep;
  std::vector<std::vector<PointCloud>> scans(lidars.size());
  const auto is_enough = [&](const auto& of_lidar) { return of_lidar.size() >= kScans; };
  int frames = 0;
  for (const int index : drive.frame_indices()) {
    if (frames == kMostFrames || std::all_of(scans.begin(), scans.end(), is_enough)) break;
    const LoadedFrame result = source.load(index);
    const auto* frame = std::get_if<Frame>(&result);
    if (frame == nullptr) continue;
    ++frames;
    std::vector<PointCloud> of_sensors = scans_by_sensor(frame->scan, lidars);
    for (std::size_t k = 0; k < lidars.size(); ++k) {
      if (is_enough(scans[k]) || of_sensors[k].empty()) continue;
      scans[k].push_back(std::move(of_sensors[k]));
    }
  }
  for (std::size_t k = 0; k < lidars.size(); ++k) {
    SensorProfile& profile = lidars[k].profile;
    const std::optional<double> first_height = lidars.front().profile.height;
    // A further LiDAR may be tilted, and then the ground is not level in its frame.
    if (k > 0 && first_height) {
      profile.height = *first_height + lidars[k].T_lidar_sensor.translation().z();
    }
    profile = estimate_sensor_profile(scans[k], profile);
  }
  return lidars;
}

std::vector<Eigen::Vector3d> lidar_origins(const DriveInfo& drive) {
  std::vector<Eigen::Vector3d> origins;
  origins.reserve(drive.lidars.size());
  for (const MountedLidar& lidar : drive.lidars) {
    origins.push_back(lidar.T_lidar_sensor.translation());
  }
  if (origins.empty()) origins.emplace_back(Eigen::Vector3d::Zero());
  return origins;
}

double farthest_lidar(const std::vector<Eigen::Vector3d>& lidar_origins) {
  double farthest = 0;
  for (const Eigen::Vector3d& origin : lidar_origins) farthest = std::max(farthest, origin.norm());
  return farthest;
}

std::vector<SensorView> sensor_views(const PointCloud& scan_lidar, const DriveInfo& drive) {
  if (drive.lidars.size() < 2) {
    return {{RangeImage(scan_lidar.position, row_height_of(first_lidar(drive)))}};
  }
  const std::vector<PointCloud> scans = scans_by_sensor(scan_lidar, drive.lidars);
  std::vector<SensorView> views;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const MountedLidar& lidar = drive.lidars[k];
    views.push_back(
        {RangeImage(scans[k].position, row_height_of(lidar.profile)), lidar.T_lidar_sensor});
  }
  return views;
}

DriveInfo info_with_lidars(const FrameSource& source) {
  DriveInfo drive = source.info();
  drive.lidars = mounted_lidars(source);
  return drive;
}

MapperOptions suited_to(const SensorProfile& profile, MapperOptions options) {
  // Lower limits: 64 rings (HDL-64E). Upper limits: the surface between rings is a guess.
  constexpr double kLeastPlanarEdge = 1, kMostPlanarEdge = 4;  // m
  constexpr double kLeastEdge = 0.4, kMostEdge = 1;            // m
  constexpr double kLeastRangeNoise = 0.02;                    // m
  const double gap_on_wall = profile.ring_spacing * kRange;
  SurfaceOptions& surface = options.surface;
  if (surface.max_edge == 0) {
    surface.max_edge = std::clamp(1.2 * gap_on_wall, kLeastEdge, kMostEdge);
  }
  if (surface.planar_edge == 0) {
    surface.planar_edge =
        std::clamp(ring_gap_on_ground(profile, kRange), kLeastPlanarEdge, kMostPlanarEdge);
  }
  surface.full_density_range = options.foveal.far_range;
  options.refinement.range_noise = std::max(kLeastRangeNoise, profile.range_noise);
  return options;
}

MapperOptions suited_to(const DriveInfo& drive, const MapperOptions& options) {
  SensorProfile coarsest = first_lidar(drive);
  for (const MountedLidar& lidar : drive.lidars) {
    if (ring_gap_on_ground(lidar.profile, kRange) > ring_gap_on_ground(coarsest, kRange)) {
      coarsest = lidar.profile;
    }
  }
  for (const MountedLidar& lidar : drive.lidars) {
    coarsest.range_noise = std::max(coarsest.range_noise, lidar.profile.range_noise);
  }
  return suited_to(coarsest, options);
}

PaperOptions suited_to(const DriveInfo& drive, PaperOptions options) {
  if (options.ground.sensor_height == 0) {
    options.ground.sensor_height = lidar_height(drive);
  }
  return options;
}

}  // namespace fovea
