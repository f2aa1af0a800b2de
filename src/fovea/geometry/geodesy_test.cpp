#include "fovea/geometry/geodesy.h"

#include <gtest/gtest.h>

#include <numbers>

namespace fovea::geodesy_test {

constexpr double kDegree = std::numbers::pi / 180;

/// Radii of curvature of the WGS84 ellipsoid: of the meridian (M) and across it (N), m.
struct Curvature {
  double M, N;
  explicit Curvature(double latitude_deg) {
    constexpr double a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f);
    const double w = 1 - e2 * std::pow(std::sin(latitude_deg * kDegree), 2);
    M = a * (1 - e2) / std::pow(w, 1.5);
    N = a / std::sqrt(w);
  }
};

constexpr GeodeticPoint kKarlsruhe{49.0093, 8.4371, 114.5};

TEST(Geodesy, SmallStepsAreArcsOfTheRadiiOfCurvature) {
  const Curvature radius(kKarlsruhe.latitude);
  const double h = kKarlsruhe.altitude;
  const LocalTangentPlane local(kKarlsruhe);
  GeodeticPoint north = kKarlsruhe, east = kKarlsruhe, up = kKarlsruhe;
  north.latitude += 1e-5;
  east.longitude += 1e-5;
  up.altitude += 3;
  const auto position = [&](const GeodeticPoint& p) {
    return Eigen::Vector3d(local.T_local_enu(p).translation());
  };
  const double d_north = 1e-5 * kDegree * (radius.M + h);
  const double d_east = 1e-5 * kDegree * (radius.N + h) * std::cos(kKarlsruhe.latitude * kDegree);
  EXPECT_NEAR(d_north, 1.1121, 1e-3);  // a degree of latitude is 111.2 km at 49 degrees
  EXPECT_LT((position(north) - Eigen::Vector3d(0, d_north, 0)).norm(), 1e-6);
  EXPECT_LT((position(east) - Eigen::Vector3d(d_east, 0, 0)).norm(), 1e-6);
  EXPECT_LT((position(up) - Eigen::Vector3d(0, 0, 3)).norm(), 1e-8);
}

TEST(Geodesy, FarGroundSinksBelowTheTangentPlane) {
  GeodeticPoint far = kKarlsruhe;
  far.latitude += 0.09;  // 10 km
  const Eigen::Vector3d p = LocalTangentPlane(kKarlsruhe).T_local_enu(far).translation();
  EXPECT_NEAR(p.y(), 10'009, 5);
  EXPECT_NEAR(p.z(), -p.y() * p.y() / (2 * Curvature(kKarlsruhe.latitude).M), 0.02);
}

TEST(Geodesy, UpLeansWithTheEllipsoid) {
  // A quarter of the equator further east, "up" is the origin's east and "east" its down.
  const LocalTangentPlane local({0, 0, 0});
  const Eigen::Matrix3d R = local.T_local_enu({0, 90, 0}).rotation();
  EXPECT_LT((R.col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((R.col(0) + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((R.col(1) - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(Geodesy, GeodeticPointsComeBack) {
  const LocalTangentPlane local(kKarlsruhe);
  EXPECT_EQ(local.origin().latitude, kKarlsruhe.latitude);
  const Eigen::Vector3d p(1234.5, -678.9, 12.3);
  const GeodeticPoint there = local.to_geodetic(p);
  EXPECT_LT((local.T_local_enu(there).translation() - p).norm(), 1e-7);
}

}  // namespace fovea::geodesy_test
