#include "fovea/geometry/georeference.h"

#include <fmt/format.h>

#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>

#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr double kFalseEasting = 500'000;           // m, of every zone
constexpr double kFalseNorthingSouth = 10'000'000;  // m, south of the equator

constexpr const char* kWgs84GeographicWkt1 =
    R"w(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,)w"
    R"w(AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],)w"
    R"w(PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],)w"
    R"w(UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]])w";
constexpr const char* kEcefWkt1 =
    R"w(GEOCCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,)w"
    R"w(AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],)w"
    R"w(PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],)w"
    R"w(UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Geocentric X",OTHER],)w"
    R"w(AXIS["Geocentric Y",OTHER],AXIS["Geocentric Z",NORTH],AUTHORITY["EPSG","4978"]])w";
constexpr const char* kEllipsoidalHeightWkt1 =
    R"w(VERT_CS["Ellipsoid (metre)",VERT_DATUM["Ellipsoid",2002],)w"
    R"w(UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Ellipsoidal height",UP]])w";
constexpr const char* kWgs84DatumWkt2 =
    R"w(DATUM["World Geodetic System 1984",)w"
    R"w(ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]],)w"
    R"w(PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174532925199433]])w";
constexpr const char* kMetreWkt2 = R"w(LENGTHUNIT["metre",1])w";
constexpr const char* kDegreeWkt2 = R"w(ANGLEUNIT["degree",0.0174532925199433])w";

bool on_earth(const GeodeticPoint& point) {
  // Written so that NaN fails.
  return std::abs(point.latitude) <= 90 && std::abs(point.longitude) <= 360 &&
         std::abs(point.altitude) <= 1e6;
}

}  // namespace

const char* to_string(Crs crs) {
  switch (crs) {
    case Crs::kLocal:
      return "local";
    case Crs::kUtm:
      return "utm";
    case Crs::kEcef:
      return "ecef";
  }
  return "unknown";
}

std::optional<Crs> crs_of(std::string_view name) {
  for (const Crs crs : {Crs::kLocal, Crs::kUtm, Crs::kEcef}) {
    if (name == to_string(crs)) return crs;
  }
  return std::nullopt;
}

/// One zone of UTM on one side of the equator.
struct Georeference::Utm {
  Utm(const GeodeticPoint& origin, int its_zone)
      : zone(its_zone), north(origin.latitude >= 0), plane(origin) {}

  double central_meridian() const { return 6.0 * zone - 183; }
  double false_northing() const { return north ? 0 : kFalseNorthingSouth; }
  int epsg() const { return (north ? 32600 : 32700) + zone; }
  std::string name() const { return fmt::format("{}{}", zone, north ? 'N' : 'S'); }
  std::string crs_name() const { return "WGS 84 / UTM zone " + name(); }

  /// Not through UTMUPS, which refuses points beyond the zone's borders.
  Eigen::Vector3d from_local(const Eigen::Vector3d& p_local) const {
    const GeodeticPoint point = plane.to_geodetic(p_local);
    double x = 0, y = 0;
    GeographicLib::TransverseMercator::UTM().Forward(central_meridian(), point.latitude,
                                                     point.longitude, x, y);
    return {x + kFalseEasting, y + false_northing(), point.altitude};
  }

  int zone;
  bool north;
  LocalTangentPlane plane;
};

Georeference::Georeference(Crs crs, const std::optional<GeodeticPoint>& origin,
                           std::string_view where)
    : crs_(crs), origin_(origin) {
  if (origin_ && !on_earth(*origin_)) {
    throw InputError(
        fmt::format("the map's origin is no place on earth (latitude {}, longitude {}, "
                    "altitude {})",
                    origin_->latitude, origin_->longitude, origin_->altitude),
        where, "restore the map from a copy or map the drive again");
  }
  if (crs_ == Crs::kLocal) return;
  if (!origin_) {
    throw InputError(
        fmt::format("the map has no georeference, which '{}' coordinates need", to_string(crs_)),
        where, "export it with --crs local, or map a drive that has GPS/INS");
  }
  if (crs_ == Crs::kEcef) T_ecef_local_ = T_ecef_enu(*origin_);
  if (crs_ != Crs::kUtm) return;
  const int zone = GeographicLib::UTMUPS::StandardZone(origin_->latitude, origin_->longitude);
  if (zone < GeographicLib::UTMUPS::MINUTMZONE) {
    throw InputError(
        fmt::format("no UTM zone covers the map's origin at latitude {}", origin_->latitude), where,
        "export it with --crs ecef or --crs local");
  }
  utm_ = std::make_unique<Utm>(*origin_, zone);
}

Georeference::~Georeference() = default;
Georeference::Georeference(Georeference&&) noexcept = default;

Eigen::Vector3d Georeference::from_local(const Eigen::Vector3d& p_local) const {
  switch (crs_) {
    case Crs::kLocal:
      return p_local;
    case Crs::kUtm:
      return utm_->from_local(p_local);
    case Crs::kEcef:
      return T_ecef_local_ * p_local;
  }
  return p_local;
}

std::string Georeference::description() const {
  if (crs_ == Crs::kEcef) return "earth-centred, earth-fixed, WGS 84 (EPSG 4978)";
  if (crs_ == Crs::kUtm) {
    return fmt::format("UTM zone {} on WGS 84 (EPSG {}), ellipsoidal heights", utm_->name(),
                       utm_->epsg());
  }
  if (!origin_) return "the map's own axes, not georeferenced";
  return fmt::format("east-north-up metres; origin latitude {} longitude {} degrees, altitude {} m",
                     origin_->latitude, origin_->longitude, origin_->altitude);
}

std::string Georeference::wkt1() const {
  if (crs_ == Crs::kEcef) return kEcefWkt1;
  if (crs_ == Crs::kLocal) {
    // Two axes: PROJ takes no LOCAL_CS with three.
    return fmt::format(
        R"w(LOCAL_CS["Fovea local ({})",LOCAL_DATUM["Fovea map",32767],UNIT["metre",1,AUTHORITY["EPSG","9001"]],{}])w",
        description(),
        origin_ ? R"w(AXIS["East",EAST],AXIS["North",NORTH])w"
                : R"w(AXIS["X",OTHER],AXIS["Y",OTHER])w");
  }
  return fmt::format(R"w(COMPD_CS["{} + Ellipsoid (metre)",{},{}])w", utm_->crs_name(),
                     wkt1_in_plan(), kEllipsoidalHeightWkt1);
}

std::string Georeference::wkt1_in_plan() const {
  if (crs_ != Crs::kUtm) return wkt1();
  return fmt::format(R"w(PROJCS["{}",{},PROJECTION["Transverse_Mercator"],)w"
                     R"w(PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",{}],)w"
                     R"w(PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],)w"
                     R"w(PARAMETER["false_northing",{}],UNIT["metre",1,AUTHORITY["EPSG","9001"]],)w"
                     R"w(AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG","{}"]])w",
                     utm_->crs_name(), kWgs84GeographicWkt1, utm_->central_meridian(),
                     utm_->false_northing(), utm_->epsg());
}

std::string Georeference::wkt2() const {
  if (crs_ == Crs::kEcef) {
    return fmt::format(
        R"w(GEODCRS["WGS 84",{},CS[Cartesian,3],AXIS["(X)",geocentricX],AXIS["(Y)",geocentricY],)w"
        R"w(AXIS["(Z)",geocentricZ],{},ID["EPSG",4978]])w",
        kWgs84DatumWkt2, kMetreWkt2);
  }
  if (crs_ == Crs::kUtm) {
    return fmt::format(
        R"w(PROJCRS["WGS 84 / UTM zone {0}",BASEGEOGCRS["WGS 84",{1},ID["EPSG",4979]],)w"
        R"w(CONVERSION["UTM zone {0}",METHOD["Transverse Mercator",ID["EPSG",9807]],)w"
        R"w(PARAMETER["Latitude of natural origin",0,{2},ID["EPSG",8801]],)w"
        R"w(PARAMETER["Longitude of natural origin",{3},{2},ID["EPSG",8802]],)w"
        R"w(PARAMETER["Scale factor at natural origin",0.9996,SCALEUNIT["unity",1],)w"
        R"w(ID["EPSG",8805]],PARAMETER["False easting",500000,{4},ID["EPSG",8806]],)w"
        R"w(PARAMETER["False northing",{5},{4},ID["EPSG",8807]]],CS[Cartesian,3],)w"
        R"w(AXIS["(E)",east,ORDER[1],{4}],AXIS["(N)",north,ORDER[2],{4}],)w"
        R"w(AXIS["ellipsoidal height (h)",up,ORDER[3],{4}]])w",
        utm_->name(), kWgs84DatumWkt2, kDegreeWkt2, utm_->central_meridian(), kMetreWkt2,
        utm_->false_northing());
  }
  if (!origin_) {
    return fmt::format(
        R"w(ENGCRS["Fovea local",EDATUM["first scan of the map"],CS[Cartesian,3],)w"
        R"w(AXIS["(x)",unspecified],AXIS["(y)",unspecified],AXIS["(z)",unspecified],{}])w",
        kMetreWkt2);
  }
  return fmt::format(
      R"w(PROJCRS["Fovea local",BASEGEOGCRS["WGS 84",{0},ID["EPSG",4979]],)w"
      R"w(CONVERSION["east-north-up at the map's origin",)w"
      R"w(METHOD["Geographic/topocentric conversions",ID["EPSG",9837]],)w"
      R"w(PARAMETER["Latitude of topocentric origin",{1},{2},ID["EPSG",8834]],)w"
      R"w(PARAMETER["Longitude of topocentric origin",{3},{2},ID["EPSG",8835]],)w"
      R"w(PARAMETER["Ellipsoidal height of topocentric origin",{4},{5},ID["EPSG",8836]]],)w"
      R"w(CS[Cartesian,3],AXIS["topocentric East (U)",east,ORDER[1],{5}],)w"
      R"w(AXIS["topocentric North (V)",north,ORDER[2],{5}],)w"
      R"w(AXIS["topocentric height (W)",up,ORDER[3],{5}]])w",
      kWgs84DatumWkt2, origin_->latitude, kDegreeWkt2, origin_->longitude, origin_->altitude,
      kMetreWkt2);
}

}  // namespace fovea
