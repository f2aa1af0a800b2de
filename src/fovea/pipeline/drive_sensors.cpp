#include "fovea/pipeline/drive_sensors.h"

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "fovea/mapping/sensor_profile_estimate.h"

namespace fovea {
namespace {

SensorProfile first_lidar(const DriveInfo& drive) {
  return drive.lidars.empty() ? SensorProfile() : drive.lidars.front();
}

}  // namespace

double lidar_height(const DriveInfo& drive) {
  return first_lidar(drive).height.value_or(kUsualSensorHeight);
}

SensorProfile lidar_profile(const FrameSource& source) {
  constexpr std::size_t kScans = 2;
  const DriveInfo& drive = source.info();
  std::vector<PointCloud> scans;
  for (const int index : drive.frame_indices()) {
    if (scans.size() == kScans) break;
    LoadedFrame result = source.load(index);
    if (auto* frame = std::get_if<Frame>(&result)) scans.push_back(std::move(frame->scan));
  }
  SensorProfile stated;
  stated.sweep = drive.sweep;
  return estimate_sensor_profile(scans, stated);
}

DriveInfo info_with_lidars(const FrameSource& source) {
  DriveInfo drive = source.info();
  drive.lidars = {lidar_profile(source)};
  return drive;
}

MapperOptions suited_to(const SensorProfile& profile, MapperOptions options) {
  // Surfaces must close between rings up to this range: the end of the white zone.
  constexpr double kRange = 15;  // m
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
  // A margin: motion compensation scatters the elevations of a ring.
  const double spacing = ring_spacing_at(profile, elevation_on_ground(profile, kRange));
  options.dynamic.row_height = std::max(RangeImage::kLeastRowHeight, 1.1 * spacing);
  options.refinement.range_noise = std::max(kLeastRangeNoise, profile.range_noise);
  return options;
}

MapperOptions suited_to(const DriveInfo& drive, const MapperOptions& options) {
  return suited_to(first_lidar(drive), options);
}

PaperOptions suited_to(const DriveInfo& drive, PaperOptions options) {
  if (options.ground.sensor_height == 0) {
    options.ground.sensor_height = lidar_height(drive);
  }
  return options;
}

}  // namespace fovea
