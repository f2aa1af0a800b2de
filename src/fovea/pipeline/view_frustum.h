// The part of a tile's space that a camera sees.
#pragma once

#include <algorithm>
#include <array>

#include "fovea/camera.h"
#include "fovea/map/tile_points.h"

namespace fovea {

/// The five planes that bound a camera's view, in tile coordinates. Rejects boxes of points without
/// projecting each point.
class ViewFrustum {
 public:
  ViewFrustum(const Camera& camera, const RigidMotion& T_cam_tile);

  /// False only for a box that lies outside one of the planes.
  bool may_contain(const TilePoints::Box& box) const {
    const auto corner = [](const TilePoints::Steps& steps) -> Eigen::Array3f {
      return Eigen::Array3f(steps[0], steps[1], steps[2]) * kPositionStep;
    };
    const Eigen::Array3f low = corner(box.low), high = corner(box.high);
    const Eigen::Vector3f center = (low + high) / 2, half = (high - low) / 2;
    return std::all_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
      return plane.normal.dot(center) + plane.normal.cwiseAbs().dot(half) + plane.offset >= 0;
    });
  }

 private:
  struct Plane {
    Eigen::Vector3f normal;  // to the inside
    float offset;
  };
  std::array<Plane, 5> planes_;
};

}  // namespace fovea
