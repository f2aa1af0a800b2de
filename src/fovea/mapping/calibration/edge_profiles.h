// What an image shows around the edges that a LiDAR expects in it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fovea/base/image.h"
#include "fovea/geometry/camera.h"
#include "fovea/mapping/calibration/lidar_edges.h"

namespace fovea {

/// What an edge's place depends on: a rotation vector of the camera in its own axes (rad), a delay
/// of the image (s), and two shifts (pixels) that are no calibration: of edges along a ring, to the
/// outside (a beam has a width, things look fatter than they are), and of edges between rings,
/// downwards (a roof ends further away than where the last beam met it, and the camera does not
/// sit where the LiDAR does).
using CalibrationVector = Eigen::Matrix<double, 6, 1>;

/// One expected edge in an image.
struct EdgeProfile {
  static constexpr int kReach = 24;  ///< pixels to either side
  static constexpr int kSize = 2 * kReach + 1;
  /// Strength of the image's edge at -kReach ... kReach pixels from where the edge is expected,
  /// along the way from inside to outside; all of them add up to less than 1.
  std::array<float, kSize> strength{};
  float half_gap = 0;      ///< pixels: the thing ends this far to either side of the expected place
  float ring_spacing = 0;  ///< rad: of the LiDAR's rings in view
  int frame = 0;
  std::array<int, 3> place{};  ///< cell of 2 m in the local frame: the thing that it belongs to
  /// Way of the expected place in u and v (pixels) by rotation and delay: exp(r) * T_cam_lidar,
  /// and Camera::image_delay.
  Eigen::Matrix<float, 2, 4> J;
  /// The same along the profile, by all parameters.
  Eigen::Matrix<float, 6, 1> J_along;
};

/// An image and from where it was taken.
struct EdgeView {
  Camera camera;  ///< image_delay included
  /// Twist per second of the LiDAR in its own frame.
  Twist velocity = Twist::Zero();
  RigidMotion T_local_lidar = RigidMotion::Identity();  ///< at the scan's stamp
  int frame = 0;
};

/// Profiles of the edges that lie in the image, each along the normal of the line that it forms
/// with its neighbours; an edge that forms none has no profile.
/// @param edges_lidar  at the scan's stamp (motion compensated)
std::vector<EdgeProfile> edge_profiles(const LidarEdges& edges_lidar, const Image& image,
                                       const EdgeView& view);

}  // namespace fovea
