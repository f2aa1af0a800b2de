#include "fovea/pipeline/lidar_views.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/angle.h"
#include "fovea/point_cloud.h"

namespace fovea::lidar_views_test {

/// Number of views that contain a point 10 m away.
int views_of(double azimuth_deg, double elevation_deg) {
  const double azimuth = azimuth_deg * kDegree, elevation = elevation_deg * kDegree;
  const Eigen::Vector3d p_lidar =
      10 * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  int count = 0;
  for (const Camera& view : lidar_views()) {
    const auto pixel = view.project(view.T_cam_lidar * p_lidar);
    if (pixel && view.in_view(*pixel)) ++count;
  }
  return count;
}

TEST(LidarViews, CoverAllAzimuthsAndOverlapAtTheirBorders) {
  for (int azimuth = -180; azimuth < 180; ++azimuth) {
    for (const int elevation : {-45, -25, 0, 25, 45}) {
      EXPECT_GE(views_of(azimuth, elevation), 1) << azimuth << " " << elevation;
    }
  }
  for (const int border : {-135, -45, 45, 135}) EXPECT_EQ(views_of(border, 0), 2);
  for (const int center : {-90, 0, 90, 180}) EXPECT_EQ(views_of(center, 0), 1);
}

TEST(LidarViews, AreUprightAtTheLidarWithoutNumber) {
  for (const Camera& view : lidar_views()) {
    EXPECT_EQ(view.index, kNoCamera);
    EXPECT_EQ(view.center_lidar().norm(), 0);
    EXPECT_LT(
        (view.T_cam_lidar.linear() * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitY()).norm(),
        1e-12);
  }
}

TEST(LidarViews, BeginAtAnyPlace) {
  const Eigen::Vector3d origin(1, -2, 0.5);
  for (const Camera& view : lidar_views(origin)) {
    EXPECT_LT((view.center_lidar() - origin).norm(), 1e-12);
  }
}

}  // namespace fovea::lidar_views_test
