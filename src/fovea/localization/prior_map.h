// The surfaces around a place, as scans are registered to them.
#pragma once

#include <optional>

#include "fovea/localization/surface_source.h"
#include "fovea/mapping/fusion/plan_view.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// How far from the sensor points are registered, m. Maps reach some 15 m beside the road; what is
/// further along it adds little.
inline constexpr double kLocalizationRange = 50;

class PriorMap {
 public:
  /// The surfaces around a place, in the axes of local, relative to the place.
  struct Target {
    Eigen::Vector3d center_local = Eigen::Vector3d::Zero();
    RegistrationCloud cloud;  ///< with normals
    PointIndex index;         ///< of its points
    PlanView plan;
  };

  /// @param source        must outlive this
  /// @param registration  how normals are computed
  PriorMap(SurfaceSource& source, const RegistrationOptions& registration);

  /// For scans that were taken near a place; valid until the next call. InputError if the map is
  /// damaged there.
  const Target& around(const Eigen::Vector3d& place_local);

 private:
  SurfaceSource& source_;
  RegistrationOptions registration_;
  std::optional<Target> target_;
};

}  // namespace fovea
