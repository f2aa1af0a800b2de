#include <stdexcept>

#include "fovea/mapping/registration/registration.h"

namespace fovea {
namespace {

RegistrationCloud prepared(const PointCloud& scan, const RegistrationOptions& options) {
  if (!scan.origin.isZero()) {
    throw std::invalid_argument("register_scans: the origin of a scan is its sensor, 0");
  }
  return prepare_cloud(scan.position, options);
}

}  // namespace

RegistrationResult register_scans(const PointCloud& target, const PointCloud& source,
                                  const RigidMotion& guess, const RegistrationOptions& options,
                                  const std::optional<PosePrior>& prior) {
  const RegistrationCloud target_cloud = prepared(target, options);
  const PointIndex index(target_cloud.points);
  return register_clouds(target_cloud, index, prepared(source, options), guess, options, prior);
}

}  // namespace fovea
