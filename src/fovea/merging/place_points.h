// Points of tiles of two maps at one place.
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/map/tile_map.h"
#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// Points of two maps nearer than this show one surface: what is left of registration and of the
/// LiDAR's noise, m.
inline constexpr float kSameSurface = 0.05f;
/// Whether the nearest point of a surface, within kSameSurface, shows the surface of another point.
/// Where no camera saw the surface, its points may be as sparse as the scan.
/// @param spacing  of the maps' points, m
inline bool shows_surface(float squared_distance, bool surface_has_color, bool point_has_color,
                          float spacing) {
  return surface_has_color || !point_has_color || squared_distance < spacing * spacing;
}

/// What an index of a map's points is built for, m.
inline constexpr double kIndexSpacing = kSameSurface / 4;

/// Points of some tiles around a place, and where each comes from.
class PlacePoints {
 public:
  explicit PlacePoints(const Eigen::Vector3d& center_local) : center_local_(center_local) {}

  /// The points of a tile that lie in a ball of `radius` m around the place.
  /// @param tile    a number by which from() names it
  /// @param points  PointCloud or TilePoints
  template <class Tile>
  void add(std::size_t tile, const Tile& points, const RigidMotion& T_local_submap, double radius) {
    const Eigen::Matrix3f R = T_local_submap.linear().cast<float>();
    const Eigen::Vector3d origin = T_local_submap * points.origin - center_local_;
    const Eigen::Vector3f t = origin.cast<float>();
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f p = R * position_in(points, i) + t;
      if (p.norm() > float(radius)) continue;
      position_.push_back(p);
      from_.push_back({std::uint32_t(tile), i});
    }
  }

  struct From {
    std::uint32_t tile, point;
  };
  /// In the axes of local, relative to the place.
  const std::vector<Eigen::Vector3f>& position() const { return position_; }
  const From& from(std::size_t i) const { return from_[i]; }

 private:
  static Eigen::Vector3f position_in(const PointCloud& tile, std::size_t i) {
    return tile.position[i];
  }
  static Eigen::Vector3f position_in(const TilePoints& tile, std::size_t i) {
    return tile.position_at(i);
  }

  Eigen::Vector3d center_local_;
  std::vector<Eigen::Vector3f> position_;
  std::vector<From> from_;
};

}  // namespace fovea
