// A map's points in the coordinates of the earth, and the text that names these coordinates.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "fovea/geometry/geodesy.h"

namespace fovea {

enum class Crs {
  kLocal,  ///< the map's own: east-north-up at its origin, or its first scan's axes
  kUtm,    ///< easting, northing of the origin's UTM zone on WGS 84; ellipsoidal height
  kEcef    ///< earth-centred, earth-fixed, WGS 84 (EPSG 4978)
};

/// "local", "utm" or "ecef".
const char* to_string(Crs crs);
/// The one of that name, or nothing.
std::optional<Crs> crs_of(std::string_view name);

/// Takes positions from a map's local frame to a CRS. Zone and hemisphere of UTM are the origin's,
/// so that a map across a border has one grid.
class Georeference {
 public:
  /// @param origin  of the local frame, if its place on earth is known
  /// @param where   names the map in errors
  /// InputError if `crs` is not local and there is no origin, if it lies not on earth, or if UTM
  /// does not cover it (beyond 84 degrees north and 80 south).
  Georeference(Crs crs, const std::optional<GeodeticPoint>& origin, std::string_view where);
  ~Georeference();
  Georeference(Georeference&&) noexcept;

  Crs crs() const { return crs_; }
  const std::optional<GeodeticPoint>& origin() const { return origin_; }

  Eigen::Vector3d from_local(const Eigen::Vector3d& p_local) const;

  /// "UTM zone 32N on WGS 84 (EPSG 32632), ellipsoidal heights", for people.
  std::string description() const;
  /// WKT 1 (OGC 01-009), as LAS files carry it. UTM with heights is COMPD_CS with a vertical datum
  /// of type 2002, ellipsoidal, the form that PROJ reads and writes for three-dimensional CRS.
  std::string wkt1() const;
  /// As wkt1(), without heights: for pictures and maps in plan.
  std::string wkt1_in_plan() const;
  /// WKT 2 (ISO 19162:2019), in which also the local frame of a georeferenced map has its place on
  /// earth (topocentric coordinates).
  std::string wkt2() const;

 private:
  struct Utm;

  Crs crs_;
  std::optional<GeodeticPoint> origin_;
  RigidMotion T_ecef_local_ = RigidMotion::Identity();
  std::unique_ptr<Utm> utm_;
};

}  // namespace fovea
