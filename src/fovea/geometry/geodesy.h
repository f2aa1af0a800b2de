// WGS84 positions and the local east-north-up frame (GeographicLib).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fovea/rigid_motion.h"

namespace fovea {

struct GeodeticPoint {
  double latitude = 0, longitude = 0;  ///< degrees, WGS84
  double altitude = 0;                 ///< m above the ellipsoid
};

enum class HeightType {
  kEllipsoidal,  ///< above the ellipsoid
  kOrthometric,  ///< above the geoid, which is up to 100 m from the ellipsoid
};

/// What coordinates refer to, as far as it is stated.
struct CoordinateReference {
  std::optional<std::string> datum;  ///< "ITRF2014", "ETRS89"
  std::optional<double> epoch_year;  ///< of the datum, as a decimal year
  std::optional<HeightType> heights;
};

/// The east-north-up frame at `point` in earth-centred, earth-fixed coordinates (WGS 84).
RigidMotion T_ecef_enu(const GeodeticPoint& point);

/// East-north-up frame tangent to the ellipsoid at `origin`.
class LocalTangentPlane {
 public:
  explicit LocalTangentPlane(const GeodeticPoint& origin);
  ~LocalTangentPlane();
  LocalTangentPlane(LocalTangentPlane&&) noexcept;
  LocalTangentPlane& operator=(LocalTangentPlane&&) noexcept;

  const GeodeticPoint& origin() const { return origin_; }

  /// T_local_enu: the east-north-up frame AT `point` expressed in this one. Away from the origin
  /// "up" leans (0.5 arc seconds at 15 m), which a long drive feels.
  RigidMotion T_local_enu(const GeodeticPoint& point) const;

  GeodeticPoint to_geodetic(const Eigen::Vector3d& p_local) const;

 private:
  GeodeticPoint origin_;
  struct Projection;
  std::unique_ptr<Projection> projection_;
};

}  // namespace fovea
