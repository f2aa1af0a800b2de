// Profiles of an image across the edges that a LiDAR expects in it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fovea/image.h"
#include "fovea/mapping/calibration/camera_correction.h"
#include "fovea/mapping/calibration/lidar_edges.h"

namespace fovea {

/// One expected edge in an image.
struct EdgeProfile {
  static constexpr int kReach = 24;  ///< pixels to either side
  static constexpr int kSize = 2 * kReach + 1;
  /// Strength of the image's edge at -kReach ... kReach pixels from the expected position, along
  /// the direction from inside to outside. The sum is below 1.
  std::array<float, kSize> strength{};
  float half_gap = 0;  ///< pixels: the object ends within this distance of the expected position
  float ring_spacing = 0;  ///< rad: of the LiDAR's rings in view
  int frame = 0;
  std::array<int, 3> place{};                        ///< cell of 2 m in the local frame: the object
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();   ///< the expected position
  Eigen::Vector2f normal = Eigen::Vector2f::Zero();  ///< direction of the profile, of length 1
  /// Derivative of the expected position (u, v in pixels) by the calibration (CameraCorrection).
  Eigen::Matrix<float, 2, kCalibrationSize> J;
  /// Derivative of the position along the profile by all parameters.
  Eigen::Matrix<float, 9, 1> J_along;
};

/// Number of the cell of 2 m that a point is in. Points of one cell belong to one object and have
/// common errors.
std::array<int, 3> object_cell(const Eigen::Vector3d& p_local);

/// The pose of an image.
struct EdgeView {
  Camera camera;  ///< its image_delay counts from the time of the edges
  /// Twist per second of the LiDAR in its own frame.
  Twist velocity = Twist::Zero();
  RigidMotion T_local_lidar = RigidMotion::Identity();  ///< at the time of the edges
  int frame = 0;
};

/// Profiles of the edges in the image, each along the normal of the line through the edge and its
/// neighbors. An edge without such a line has no profile.
/// @param edges_lidar  at one time, such as the scan's stamp (motion compensated)
std::vector<EdgeProfile> edge_profiles(const LidarEdges& edges_lidar, const Image& image,
                                       const EdgeView& view);
/// The profiles of the edges of several LiDARs.
std::vector<EdgeProfile> profiles_of_lidars(const std::vector<LidarEdges>& edges_lidar,
                                            const Image& image, const EdgeView& view);

}  // namespace fovea
