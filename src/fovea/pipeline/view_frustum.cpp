#include "fovea/pipeline/view_frustum.h"

namespace fovea {
namespace {

/// Points are projected in single precision (m).
constexpr float kEpsilon = 1e-3f;

}  // namespace

ViewFrustum::ViewFrustum(const Camera& camera, const RigidMotion& T_cam_tile) {
  const std::array<Eigen::Vector3d, 5> inwards{
      Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(camera.fx, 0, camera.cx),
      Eigen::Vector3d(-camera.fx, 0, camera.width - 1 - camera.cx),
      Eigen::Vector3d(0, camera.fy, camera.cy),
      Eigen::Vector3d(0, -camera.fy, camera.height - 1 - camera.cy)};
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Eigen::Vector3d normal_cam = inwards[i].normalized();
    planes_[i].normal = (T_cam_tile.linear().transpose() * normal_cam).cast<float>();
    planes_[i].offset = static_cast<float>(normal_cam.dot(T_cam_tile.translation())) + kEpsilon;
  }
}

}  // namespace fovea
