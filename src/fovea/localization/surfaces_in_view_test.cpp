#include "fovea/localization/surfaces_in_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/angle.h"

namespace fovea::surfaces_in_view_test {

/// A scan of a round wall, 20 m away.
RangeImage round_wall() {
  std::vector<Eigen::Vector3f> points;
  for (double elevation = -20; elevation <= 20; elevation += 0.4) {
    for (double azimuth = 0; azimuth < 360; azimuth += 0.25) {
      const double e = elevation * kDegree, a = azimuth * kDegree;
      const Eigen::Vector3d direction(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a),
                                      std::sin(e));
      points.emplace_back((20 / std::cos(e) * direction).cast<float>());
    }
  }
  return RangeImage(points);
}

RegistrationCloud vertical_surfaces(const std::vector<Eigen::Vector3f>& points) {
  RegistrationCloud cloud;
  cloud.points = points;
  cloud.normals.assign(points.size(), Eigen::Vector3f::UnitX());
  return cloud;
}

TEST(SurfacesInView, TheScanSeesThroughWhatIsNearerThanItsWall) {
  const RegistrationCloud map =
      vertical_surfaces({{10, 0, 1}, {20, 0, 1}, {0, 20, -1}, {25, 0, 1}});
  const SurfacesInView view = surfaces_in_view(map, round_wall(), RigidMotion::Identity());
  EXPECT_EQ(view.through, 1u);
  EXPECT_EQ(view.seen, 2u);  // the one behind the wall is hidden
  EXPECT_DOUBLE_EQ(view.share_through(), 1.0 / 3);
}

TEST(SurfacesInView, HeightIsThatOfTheMapAlsoForALidarUpsideDown) {
  const RegistrationCloud map = vertical_surfaces({{10, 0, 3}, {20, 0, 1}, {20, 0, -1}});
  RigidMotion T_map_lidar(Eigen::AngleAxisd(180 * kDegree, Eigen::Vector3d::UnitX()));
  EXPECT_EQ(surfaces_in_view(map, round_wall(), T_map_lidar, /*lowest=*/2).count(), 1u);
  EXPECT_EQ(surfaces_in_view(map, round_wall(), T_map_lidar, /*lowest=*/0).count(), 2u);
  EXPECT_EQ(surfaces_in_view(map, round_wall(), T_map_lidar).count(), 3u);
}

TEST(SurfacesInView, NoneIsNoContradiction) {
  const SurfacesInView view = surfaces_in_view({}, round_wall(), RigidMotion::Identity());
  EXPECT_EQ(view.count(), 0u);
  EXPECT_EQ(view.share_through(), 0);
}

}  // namespace fovea::surfaces_in_view_test
