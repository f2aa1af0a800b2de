#include "fovea/merging/free_space.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "fovea/map/keyframe_returns.h"
#include "fovea/merging/placed_keyframes.h"

namespace fovea {
namespace {

constexpr double kReach = 40;  // m, from a sensor to the points that it may see through
constexpr float kVoxel = 0.15f;
constexpr int kMinFree = 3, kFreePerSurface = 4;
constexpr double kRowPerSpacing = 1.5;  // height of a row, in ring spacings

double row_height(const SensorProfile& profile) {
  return std::max(RangeImage::kLeastRowHeight, kRowPerSpacing * profile.ring_spacing);
}

}  // namespace

FreeSpace::FreeSpace(const MapReader& map, const MapContent& content,
                     const std::vector<RigidMotion>& T_cell_submap, double size) {
  for_each_placed_keyframe(map, content, [&](const PlacedKeyframe& keyframe) {
    const RigidMotion T_cell_sensor = T_cell_submap.at(keyframe.submap) * keyframe.T_submap_sensor;
    if (T_cell_sensor.translation().head<2>().cwiseAbs().maxCoeff() > size / 2 + kReach) return;
    views_.push_back({RangeImage(returns_of(keyframe.image), row_height(keyframe.profile)),
                      T_cell_sensor.inverse()});
  });
}

std::vector<bool> FreeSpace::contains(const TilePoints& points,
                                      const RigidMotion& T_cell_submap) const {
  // Points of one voxel have the verdict of the first of them.
  std::map<std::array<int, 3>, std::uint32_t> voxels;
  std::vector<std::uint32_t> voxel_of(points.size());
  std::vector<Eigen::Vector3f> places_cell;
  const Eigen::Isometry3f T = T_cell_submap.cast<float>();
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = points.position_at(i);
    const Eigen::Array3i cell = (p.array() / kVoxel).floor().cast<int>();
    const auto [voxel, is_new] =
        voxels.try_emplace({cell.x(), cell.y(), cell.z()}, std::uint32_t(places_cell.size()));
    if (is_new) places_cell.push_back(T * (points.origin.cast<float>() + p));
    voxel_of[i] = voxel->second;
  }
  std::vector<int> free(places_cell.size()), surface(places_cell.size());
  std::vector<Eigen::Vector3f> places_sensor(places_cell.size());
  std::vector<Visibility> seen(places_cell.size());
  for (const View& view : views_) {
    const Eigen::Isometry3f T_sensor_cell = view.T_sensor_cell.cast<float>();
    for (std::size_t k = 0; k < places_cell.size(); ++k) {
      places_sensor[k] = T_sensor_cell * places_cell[k];
    }
    view.image.classify(places_sensor, seen);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      if (places_sensor[k].norm() > float(kReach)) continue;
      free[k] += seen[k] == Visibility::kFree;
      surface[k] += seen[k] == Visibility::kSurface;
    }
  }
  std::vector<bool> gone(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint32_t k = voxel_of[i];
    gone[i] = free[k] >= kMinFree && free[k] > kFreePerSurface * surface[k];
  }
  return gone;
}

}  // namespace fovea
