#include "fovea/pipeline/lidar_views.h"

#include <cmath>
#include <numbers>

#include "fovea/core/angle.h"
#include "fovea/point_cloud.h"

namespace fovea {

std::vector<Camera> lidar_views(const Eigen::Vector3d& origin) {
  constexpr int kViews = 4;
  // surface.max_per_pixel limits samples by pixels: at this focal length, to 2 cm at 15 m.
  constexpr double kFocal = 360;
  const double half_width = kFocal * std::tan(48 * kDegree);
  const double half_height = kFocal * std::tan(55 * kDegree);  // 45 degrees up at the borders
  Eigen::Matrix3d R_cam_lidar;                                 // forward
  R_cam_lidar << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  std::vector<Camera> views(kViews);
  for (int i = 0; i < kViews; ++i) {
    Camera& view = views[std::size_t(i)];
    view.index = kNoCamera;
    view.width = int(std::ceil(2 * half_width));
    view.height = int(std::ceil(2 * half_height));
    view.fx = view.fy = kFocal;
    view.cx = 0.5 * (view.width - 1);
    view.cy = 0.5 * (view.height - 1);
    const Eigen::AngleAxisd turn(2 * std::numbers::pi * i / kViews, Eigen::Vector3d::UnitZ());
    view.T_cam_lidar.linear() = R_cam_lidar * turn.inverse().toRotationMatrix();
    view.T_cam_lidar.translation() = -(view.T_cam_lidar.linear() * origin);
  }
  return views;
}

}  // namespace fovea
