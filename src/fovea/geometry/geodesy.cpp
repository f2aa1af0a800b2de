#include "fovea/geometry/geodesy.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <vector>

namespace fovea {
namespace {

using RowMajorMatrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

RigidMotion T_ecef_enu(const GeodeticPoint& point) {
  Eigen::Vector3d p;
  std::vector<double> rotation(9);  // row-major
  GeographicLib::Geocentric::WGS84().Forward(point.latitude, point.longitude, point.altitude, p.x(),
                                             p.y(), p.z(), rotation);
  RigidMotion T = RigidMotion::Identity();
  T.linear() = Eigen::Map<const RowMajorMatrix3>(rotation.data());
  T.translation() = p;
  return T;
}

struct LocalTangentPlane::Projection {
  GeographicLib::LocalCartesian cartesian;
};

LocalTangentPlane::LocalTangentPlane(const GeodeticPoint& origin)
    : origin_(origin),
      projection_(std::make_unique<Projection>(Projection{
          GeographicLib::LocalCartesian(origin.latitude, origin.longitude, origin.altitude)})) {}
LocalTangentPlane::~LocalTangentPlane() = default;
LocalTangentPlane::LocalTangentPlane(LocalTangentPlane&&) noexcept = default;
LocalTangentPlane& LocalTangentPlane::operator=(LocalTangentPlane&&) noexcept = default;

RigidMotion LocalTangentPlane::T_local_enu(const GeodeticPoint& point) const {
  Eigen::Vector3d p;
  std::vector<double> rotation(9);  // row-major
  projection_->cartesian.Forward(point.latitude, point.longitude, point.altitude, p.x(), p.y(),
                                 p.z(), rotation);
  RigidMotion T = RigidMotion::Identity();
  T.linear() = Eigen::Map<const RowMajorMatrix3>(rotation.data());
  T.translation() = p;
  return T;
}

GeodeticPoint LocalTangentPlane::to_geodetic(const Eigen::Vector3d& p_local) const {
  GeodeticPoint point;
  projection_->cartesian.Reverse(p_local.x(), p_local.y(), p_local.z(), point.latitude,
                                 point.longitude, point.altitude);
  return point;
}

}  // namespace fovea
