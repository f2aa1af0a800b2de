// Many points as a camera sees them, a block at a time: each coordinate has a row of its own, on
// which the compiler works eight numbers at once.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fovea/geometry/camera.h"

namespace fovea {

class ProjectedBlock {
 public:
  static constexpr std::size_t kSize = 256;  ///< points of a block, at most

  explicit ProjectedBlock(const Camera& camera);

  /// Takes up other points.
  /// @param points_b, T_cam_b  m; as rotation and translation in float: the points are near
  void project(std::span<const Eigen::Vector3f> points_b, const Eigen::Matrix3f& R_cam_b,
               const Eigen::Vector3f& t_cam_b);
  /// The same of coordinates that are counted in steps, a row for each.
  /// @param step  m
  void project(const std::array<std::span<const std::uint16_t>, 3>& steps_b, float step,
               const Eigen::Matrix3f& R_cam_b, const Eigen::Vector3f& t_cam_b);

  /// Whether the camera sees the place of point i: in front of it, and inside the image. Of no
  /// other point does the pixel mean anything.
  bool in_view(std::size_t i) const { return in_view_[i] != 0; }
  Eigen::Vector2f pixel(std::size_t i) const { return {u_[i], v_[i]}; }
  Eigen::Vector3f p_cam(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }  ///< m
  float depth(std::size_t i) const { return z_[i]; }  ///< m along the optical axis

 private:
  /// @param coordinates  of point i, as an array
  template <class F>
  void place(std::size_t count, F&& coordinates, const Eigen::Matrix3f& R_cam_b,
             const Eigen::Vector3f& t_cam_b);

  using Row = std::array<float, kSize>;
  float fx_, fy_, cx_, cy_, right_, bottom_;
  alignas(64) Row x_{}, y_{}, z_{}, u_{}, v_{};
  alignas(64) std::array<std::int32_t, kSize> in_view_{};
};

}  // namespace fovea
