#include "fovea/mapping/projected_block.h"

namespace fovea {

ProjectedBlock::ProjectedBlock(const Camera& camera)
    : fx_(static_cast<float>(camera.fx)),
      fy_(static_cast<float>(camera.fy)),
      cx_(static_cast<float>(camera.cx)),
      cy_(static_cast<float>(camera.cy)),
      right_(static_cast<float>(camera.width - 1)),
      bottom_(static_cast<float>(camera.height - 1)) {}

void ProjectedBlock::project(std::span<const Eigen::Vector3f> points_b,
                             const Eigen::Matrix3f& R_cam_b, const Eigen::Vector3f& t_cam_b) {
  project_all(
      points_b.size(),
      [&](std::size_t i) { return std::array{points_b[i].x(), points_b[i].y(), points_b[i].z()}; },
      R_cam_b, t_cam_b);
}

void ProjectedBlock::project(const std::array<std::span<const std::uint16_t>, 3>& steps_b,
                             float step, const Eigen::Matrix3f& R_cam_b,
                             const Eigen::Vector3f& t_cam_b) {
  const std::uint16_t* const x = steps_b[0].data();
  const std::uint16_t* const y = steps_b[1].data();
  const std::uint16_t* const z = steps_b[2].data();
  project_all(
      steps_b[0].size(),
      [=](std::size_t i) {
        return std::array{float(x[i]) * step, float(y[i]) * step, float(z[i]) * step};
      },
      R_cam_b, t_cam_b);
}

template <class F>
void ProjectedBlock::project_all(std::size_t n, F&& coordinates, const Eigen::Matrix3f& R_cam_b,
                                 const Eigen::Vector3f& t_cam_b) {
  // Local copies cannot alias the arrays, so the loops vectorize.
  const Eigen::Matrix3f R = R_cam_b;
  const Eigen::Vector3f t = t_cam_b;
  const float fx = fx_, fy = fy_, cx = cx_, cy = cy_, right = right_, bottom = bottom_;
  for (std::size_t i = 0; i < n; ++i) {
    const auto [x, y, z] = coordinates(i);
    x_[i] = R(0, 0) * x + R(0, 1) * y + R(0, 2) * z + t.x();
    y_[i] = R(1, 0) * x + R(1, 1) * y + R(1, 2) * z + t.y();
    z_[i] = R(2, 0) * x + R(2, 1) * y + R(2, 2) * z + t.z();
  }
  for (std::size_t i = 0; i < n; ++i) {
    u_[i] = fx * x_[i] / z_[i] + cx;
    v_[i] = fy * y_[i] / z_[i] + cy;
    // Bitwise operators avoid branches.
    in_view_[i] = (z_[i] > float(Camera::kMinDepth)) & (u_[i] >= 0) & (v_[i] >= 0) &
                  (u_[i] <= right) & (v_[i] <= bottom);
  }
}

}  // namespace fovea
