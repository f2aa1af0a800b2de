// Projects a block of points: one array for each coordinate, so that loops vectorize.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fovea/camera.h"

namespace fovea {

class ProjectedBlock {
 public:
  static constexpr std::size_t kSize = 256;  ///< points of a block, at most

  explicit ProjectedBlock(const Camera& camera);

  /// Replaces the points of the block.
  /// @param points_b          m
  /// @param R_cam_b, t_cam_b  single precision suffices, since the points are near
  void project(std::span<const Eigen::Vector3f> points_b, const Eigen::Matrix3f& R_cam_b,
               const Eigen::Vector3f& t_cam_b);
  /// The same for quantized coordinates, one array for each axis.
  /// @param step  m
  void project(const std::array<std::span<const std::uint16_t>, 3>& steps_b, float step,
               const Eigen::Matrix3f& R_cam_b, const Eigen::Vector3f& t_cam_b);

  /// Whether point i is in front of the camera and inside the image. Only then is its pixel
  /// meaningful.
  bool in_view(std::size_t i) const { return in_view_[i] != 0; }
  Eigen::Vector2f pixel(std::size_t i) const { return {u_[i], v_[i]}; }
  Eigen::Vector3f p_cam(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }  ///< m
  float depth(std::size_t i) const { return z_[i]; }  ///< m along the optical axis

 private:
  /// @param coordinates  of point i, as an array
  template <class F>
  void project_all(std::size_t count, F&& coordinates, const Eigen::Matrix3f& R_cam_b,
                   const Eigen::Vector3f& t_cam_b);

  using Row = std::array<float, kSize>;
  float fx_, fy_, cx_, cy_, right_, bottom_;
  alignas(64) Row x_{}, y_{}, z_{}, u_{}, v_{};
  alignas(64) std::array<std::int32_t, kSize> in_view_{};
};

}  // namespace fovea
