#include "fovea/localization/prior_map.h"

#include <cmath>
#include <utility>
#include <vector>

#include "fovea/map/map_surfaces.h"
#include "fovea/mapping/fusion/place_match.h"

namespace fovea {
namespace {

/// A target serves scans taken within this of its center, m.
constexpr double kServes = 8;
constexpr double kRadius = kLocalizationRange + kServes + kPlaceReach;

}  // namespace

PriorMap::PriorMap(SurfaceSource& source, const RegistrationOptions& registration)
    : source_(source), registration_(registration) {}

const PriorMap::Target& PriorMap::around(const Eigen::Vector3d& place_local) {
  if (target_ && (target_->center_local - place_local).norm() <= kServes) return *target_;
  RegistrationCloud cloud =
      prepare_cloud(source_.points_near(place_local, kRadius), registration_, MapSurfaces::kVoxel);
  PointIndex index(cloud.points, MapSurfaces::kVoxel);
  PlanView plan(cloud.points);
  return target_.emplace(Target{place_local, std::move(cloud), std::move(index), std::move(plan)});
}

}  // namespace fovea
