#include "fovea/merging/common_space.h"

#include "fovea/map/map_surfaces.h"
#include "fovea/mapping/fusion/place_match.h"

namespace fovea {
namespace {

constexpr std::size_t kMinPoints = 500;

RegistrationOptions registration_options() {
  RegistrationOptions options;
  options.max_distance = 0.5;
  options.robust_width = 0.1;
  return options;
}

}  // namespace

PlaceTarget::PlaceTarget(std::vector<Eigen::Vector3f> points_a, const Eigen::Vector3d& center_a)
    : T_a_place(Eigen::Translation3d{center_a}),
      plan(points_a),
      cloud(prepare_cloud(std::move(points_a), registration_options(), MapSurfaces::kVoxel)),
      index(cloud.points, MapSurfaces::kVoxel) {}

bool has_common_space(const PlanView& plan_a, const std::vector<Eigen::Vector3f>& points_b,
                      const RigidMotion& guess_T_place_b) {
  return plan_a.covered(points_b, guess_T_place_b, kPlaceReach).size() >= kMinPoints;
}

std::optional<CommonSpaceFit> fit_common_space(const PlaceTarget& target,
                                               const std::vector<Eigen::Vector3f>& points_b,
                                               const RigidMotion& guess_T_target_b) {
  const RegistrationOptions options = registration_options();
  CommonSpaceFit fit;
  fit.registration.T_target_source = guess_T_target_b;
  for (int pass = 0; pass < 2; ++pass) {
    const RigidMotion T_target_b = fit.registration.T_target_source;
    fit.source = prepare_cloud(target.plan.covered(points_b, T_target_b, kPlaceReach), options,
                               MapSurfaces::kVoxel);
    const auto match = match_place(target.cloud, target.index, fit.source, T_target_b, options);
    if (!match) return std::nullopt;
    fit.registration = *match;
  }
  const RigidMotion moved = guess_T_target_b.inverse() * fit.registration.T_target_source;
  if (moved.translation().norm() > kPlaceReach) return std::nullopt;
  return fit;
}

}  // namespace fovea
