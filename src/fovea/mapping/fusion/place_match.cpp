#include "fovea/mapping/fusion/place_match.h"

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

/// Least PlaceFit::on_plane and PlaceFit::overlap.
constexpr double kMinFit = 0.7, kMinOverlap = 0.6;

}  // namespace

PlaceFit place_fit(const RegistrationCloud& target, const PointIndex& target_index,
                   const RegistrationCloud& source, const RigidMotion& T_target_source,
                   const PlaceFitOptions& options) {
  const Eigen::Matrix3f R = T_target_source.linear().cast<float>();
  const Eigen::Vector3f t = T_target_source.translation().cast<float>();
  std::size_t vertical = 0, paired = 0, on_plane = 0;
  for (std::size_t i = 0; i < source.points.size(); ++i) {
    if (!is_vertical(source.normals[i])) continue;
    ++vertical;
    const Eigen::Vector3f p = R * source.points[i] + t;
    const Neighbor nearest = target_index.nearest(p, options.pair_distance);
    if (!std::isfinite(nearest.squared_distance)) continue;
    ++paired;
    const Eigen::Vector3f& normal = target.normals[nearest.index];
    const float away = normal.dot(p - target.points[nearest.index]);
    const bool alike = std::abs(normal.dot(R * source.normals[i])) >= options.alike;
    on_plane += !normal.isZero() && alike && std::abs(away) < options.on_plane;
  }
  const auto share = [](std::size_t part, std::size_t of) {
    return of > 0 ? double(part) / double(of) : 0;
  };
  return {vertical, share(paired, vertical), share(on_plane, paired)};
}

std::optional<RegistrationResult> match_place(const RegistrationCloud& target,
                                              const PointIndex& target_index,
                                              const RegistrationCloud& source,
                                              const RigidMotion& guess_T_target_source,
                                              const RegistrationOptions& options) {
  RegistrationResult result;
  result.T_target_source = guess_T_target_source;
  for (const double distance :
       {std::max(kPlaceReach, options.max_distance), options.max_distance}) {
    RegistrationOptions step = options;
    step.max_distance = distance;
    result = register_clouds(target, target_index, source, result.T_target_source, step);
    if (!result.converged || result.degenerate_directions > 0) return std::nullopt;
  }
  const PlaceFit fit = place_fit(target, target_index, source, result.T_target_source);
  if (fit.overlap < kMinOverlap || fit.on_plane < kMinFit) return std::nullopt;
  return result;
}

}  // namespace fovea
