#include "fovea/geometry/georeference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "fovea/errors.h"

namespace fovea::georeference_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr GeodeticPoint kKarlsruhe{49.011212804408, 8.4228850417969, 112.83492279053};

double distance(const Eigen::Vector3d& a, double x, double y, double z) {
  return (a - Eigen::Vector3d(x, y, z)).norm();
}

/// Earth-centred coordinates by the closed form of the textbooks.
Eigen::Vector3d ecef(const GeodeticPoint& point) {
  constexpr double kDegree = std::numbers::pi / 180, a = 6378137, f = 1 / 298.257223563;
  constexpr double e2 = f * (2 - f);
  const double latitude = point.latitude * kDegree, longitude = point.longitude * kDegree;
  const double n = a / std::sqrt(1 - e2 * std::pow(std::sin(latitude), 2));
  return {(n + point.altitude) * std::cos(latitude) * std::cos(longitude),
          (n + point.altitude) * std::cos(latitude) * std::sin(longitude),
          (n * (1 - e2) + point.altitude) * std::sin(latitude)};
}

// The expected coordinates are PROJ 9.1's (cs2cs EPSG:4979 EPSG:32632 and EPSG:4978; cct with its
// inverse of topocentric coordinates, then utm).
TEST(Georeference, AgreesWithProj) {
  const Georeference utm(Crs::kUtm, kKarlsruhe, "a map"), world(Crs::kEcef, kKarlsruhe, "a map");
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), far(1500, -800, 12.5);
  EXPECT_LT(distance(utm.from_local(zero), 457797.929998, 5428862.693490, 112.834923), 2e-6);
  EXPECT_LT(distance(utm.from_local(far), 459291.209098, 5428051.635849, 125.561186), 2e-6);
  EXPECT_LT(distance(world.from_local(zero), 4146357.119396, 613973.097602, 4791461.916183), 2e-6);
  EXPECT_LT(distance(world.from_local(far), 4146742.869589, 615546.573234, 4790946.622602), 2e-6);
  const Georeference cape(Crs::kUtm, GeodeticPoint{-33.9, 18.4, 50}, "a map");
  EXPECT_LT(distance(cape.from_local(zero), 259583.221660, 6245888.045441, 50), 2e-6);
}

// 6,000 km from the earth's centre, a double still resolves nanometres, a float half a metre.
TEST(Georeference, EarthCentredCoordinatesKeepATenthOfAMillimetre) {
  const Georeference world(Crs::kEcef, kKarlsruhe, "a map");
  const LocalTangentPlane local(kKarlsruhe);
  for (const double east : {-3000.0, 0.0123, 4500.7}) {
    for (const double north : {-2000.25, 17.0, 5000.0}) {
      const Eigen::Vector3d p_local(east, north, 0.1 * east);
      const Eigen::Vector3d p_ecef = world.from_local(p_local);
      EXPECT_GT(p_ecef.norm(), 6.3e6);
      EXPECT_LT((p_ecef - ecef(local.to_geodetic(p_local))).norm(), 1e-4);
      EXPECT_LT((T_ecef_enu(kKarlsruhe).inverse() * p_ecef - p_local).norm(), 1e-4);
    }
  }
}

TEST(Georeference, OneZoneForAWholeMap) {
  // The border of zones 32 and 33 lies at 12 degrees east, 90 m from this origin.
  const GeodeticPoint near_border{50, 11.99874, 100};
  const Georeference utm(Crs::kUtm, near_border, "a map");
  EXPECT_THAT(utm.description(), HasSubstr("UTM zone 32N on WGS 84 (EPSG 32632)"));
  const Eigen::Vector3d before = utm.from_local({80, 0, 0}), behind = utm.from_local({100, 0, 0});
  EXPECT_NEAR((behind - before).norm(), 20, 0.02);  // the grid's scale at its zone's border
  // Likewise at the equator.
  const Georeference equator(Crs::kUtm, GeodeticPoint{1e-4, 9, 0}, "a map");
  EXPECT_NEAR(equator.from_local({0, -100, 0}).y(), -88.9, 0.1);
}

TEST(Georeference, LocalCoordinatesStayAsTheyAre) {
  const Eigen::Vector3d p(1.0 / 3, -2, 1e5);
  EXPECT_EQ(Georeference(Crs::kLocal, kKarlsruhe, "a map").from_local(p), p);
  EXPECT_EQ(Georeference(Crs::kLocal, std::nullopt, "a map").from_local(p), p);
}

TEST(Georeference, RefusesMapsWithoutAPlaceOnEarth) {
  const auto problem = [](Crs crs, std::optional<GeodeticPoint> origin) -> std::string {
    try {
      Georeference(crs, origin, "x.fovea");
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), "x.fovea");
      return error.problem();
    }
    return "";
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(problem(Crs::kUtm, std::nullopt), HasSubstr("no georeference"));
  EXPECT_THAT(problem(Crs::kEcef, std::nullopt), HasSubstr("'ecef'"));
  EXPECT_THAT(problem(Crs::kUtm, GeodeticPoint{85, 0, 0}), HasSubstr("no UTM zone"));
  EXPECT_EQ(problem(Crs::kEcef, GeodeticPoint{85, 0, 0}), "");
  for (const GeodeticPoint& nowhere : {GeodeticPoint{91, 0, 0}, GeodeticPoint{0, 1e300, 0},
                                       GeodeticPoint{kNan, 0, 0}, GeodeticPoint{0, 0, kNan}}) {
    for (const Crs crs : {Crs::kLocal, Crs::kUtm, Crs::kEcef}) {
      EXPECT_THAT(problem(crs, nowhere), HasSubstr("no place on earth"));
    }
  }
}

// That other programs understand these texts is tests/web's to show, with proj4.
TEST(Georeference, NamesItsCoordinatesInWellKnownText) {
  const Georeference utm(Crs::kUtm, kKarlsruhe, "a map"), world(Crs::kEcef, kKarlsruhe, "a map");
  EXPECT_THAT(utm.wkt1(), StartsWith("COMPD_CS[\"WGS 84 / UTM zone 32N + Ellipsoid (metre)\""));
  EXPECT_THAT(utm.wkt1(), HasSubstr("AUTHORITY[\"EPSG\",\"32632\"]"));
  EXPECT_THAT(utm.wkt1(), HasSubstr("VERT_DATUM[\"Ellipsoid\",2002]"));
  EXPECT_THAT(world.wkt1(), StartsWith("GEOCCS[\"WGS 84\""));
  EXPECT_THAT(world.wkt1(), HasSubstr("AUTHORITY[\"EPSG\",\"4978\"]"));
  const Georeference cape(Crs::kUtm, GeodeticPoint{-33.9, 18.4, 50}, "a map");
  EXPECT_THAT(cape.wkt1(), HasSubstr("PARAMETER[\"false_northing\",10000000]"));
  EXPECT_THAT(cape.wkt1(), HasSubstr("AUTHORITY[\"EPSG\",\"32734\"]"));
  const Georeference local(Crs::kLocal, kKarlsruhe, "a map");
  EXPECT_THAT(local.wkt1(), StartsWith("LOCAL_CS["));
  EXPECT_THAT(local.wkt2(), HasSubstr("topocentric origin\",49.011212804408"));
  const Georeference nowhere(Crs::kLocal, std::nullopt, "a map");
  EXPECT_THAT(nowhere.wkt1(), StartsWith("LOCAL_CS["));
  EXPECT_THAT(nowhere.wkt2(), StartsWith("ENGCRS["));
  for (const Georeference* reference : {&utm, &world, &cape, &local, &nowhere}) {
    for (const std::string& text : {reference->wkt1(), reference->wkt2()}) {
      EXPECT_EQ(std::count(text.begin(), text.end(), '['),
                std::count(text.begin(), text.end(), ']'));
      EXPECT_EQ(text.find('\n'), std::string::npos);
    }
  }
}

TEST(Georeference, NamesOfCrs) {
  for (const Crs crs : {Crs::kLocal, Crs::kUtm, Crs::kEcef}) EXPECT_EQ(crs_of(to_string(crs)), crs);
  EXPECT_FALSE(crs_of("gps"));
}

}  // namespace fovea::georeference_test
