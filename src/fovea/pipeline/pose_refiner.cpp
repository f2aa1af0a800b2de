#include "fovea/pipeline/pose_refiner.h"

#include <fmt/format.h>

#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/registration/place_search.h"
#include "fovea/mapping/registration/pose_covariance.h"
#include "fovea/pipeline/registration_check.h"

namespace fovea {
namespace {

/// Share of a scan's points that have a counterpart, below which the scan is elsewhere: even after
/// 14 m of a street, 0.7 of them have one.
constexpr double kLeastOverlap = 0.3;

NormalOptions target_normals(const RefinementOptions& options) {
  return {.neighbors = options.registration.neighbors, .range_noise = options.range_noise};
}

/// Error of a predicted pose along a direction that the scene leaves open, m.
constexpr double kOpen = 0.2;

}  // namespace

double fit_of(const RegistrationResult& result, const RegistrationOptions& options) {
  const double away = result.rms_distance / options.max_distance;
  return static_cast<double>(result.pairs) * std::max(0.0, 1 - away * away);
}

PoseRefiner::PoseRefiner(const RefinementOptions& options)
    : options_(options), local_map_(options.local_map, target_normals(options)) {}

Keyframes PoseRefiner::keyframes() const {
  const LocalMapOptions& map = options_.local_map;
  return Keyframes({map.keyframe_distance, map.keyframe_rotation, map.keyframe_overlap});
}

RegistrationCloud PoseRefiner::prepare(const PointCloud& scan_lidar) const {
  auto thinned = voxel_thinned(scan_lidar.position, static_cast<float>(options_.voxel));
  // The local map has planes of its own; GICP also needs those of the scan.
  if (options_.registration.method == RegistrationMethod::kGicp) {
    return prepare_cloud(std::move(thinned), options_.registration, options_.voxel);
  }
  return select_points(std::move(thinned), options_.registration.max_points);
}

std::string PoseRefiner::doubt_of(const AlignmentStats& alignment,
                                  const std::optional<Twist>& sigma, const VerticalFit& fit) const {
  constexpr double kDoubtful = 5;  // deviations of navigation
  if (!sigma || fit.points >= VerticalFit::kLeastPoints) return "";
  if (alignment.correction_m <= kDoubtful * sigma->tail<3>().maxCoeff() &&
      alignment.correction_rad <= kDoubtful * sigma->head<3>().maxCoeff()) {
    return "";
  }
  return fmt::format(
      "registration moved {:.2f} m off navigation and no wall confirms it, navigation kept",
      alignment.correction_m);
}

RefinedPose PoseRefiner::refine(const PointCloud& scan_lidar, const RigidMotion& guess,
                                const std::optional<Twist>& sigma, bool doubts) const {
  RefinedPose refined;
  refined.T_odom_lidar = guess;
  refined.cloud = prepare(scan_lidar);
  RegistrationStats& stats = refined.stats.emplace();
  stats.points = refined.cloud.points.size();
  if (local_map_.empty()) return refined;

  std::optional<PosePrior> prior;
  if (sigma) prior = PosePrior{guess, *sigma};
  const RegistrationResult result =
      register_to(local_map_, refined.cloud, guess, options_.registration, prior);
  AlignmentStats& alignment =
      stats.alignment.emplace(alignment_stats(result, guess.inverse() * result.T_target_source));
  VerticalFit vertical = vertical_fit(local_map_, refined.cloud, result.T_target_source);
  refined.note = failure_of(result, alignment, options_.limits);
  if (refined.note.empty() && doubts) refined.note = doubt_of(alignment, sigma, vertical);
  alignment.has_failed = !refined.note.empty();
  if (alignment.has_failed) {
    vertical = vertical_fit(local_map_, refined.cloud, guess);
  } else {
    refined.T_odom_lidar = result.T_target_source;
    refined.fit = fit_of(result, options_.registration);
    stats.covariance = pose_covariance(result, kOpen);
  }
  // The pairs of the registration give the overlap, even if its pose is rejected.
  const double overlap = stats.overlap();
  refined.lost = vertical.contradicts() || overlap < kLeastOverlap;
  refined.is_confirmed =
      !alignment.has_failed && !refined.lost && place_score(vertical, overlap) > kLeastPlaceScore;
  stats.vertical_fit = vertical.share;
  return refined;
}

RefinedPose PoseRefiner::search(RefinedPose lost, const RigidMotion& guess, double reach) const {
  RefinedPose refined = std::move(lost);
  refined.T_odom_lidar = guess;
  refined.note = "the scan fits nowhere around its first guess";
  if (local_map_.empty()) return refined;
  const auto found = search_place(local_map_, refined.cloud, guess, reach, options_.registration);
  if (!found) return refined;
  refined.lost = false;
  refined.is_confirmed = true;
  refined.T_odom_lidar = found->registration.T_target_source;
  refined.fit = fit_of(found->registration, options_.registration);
  refined.note = "the scan was found again by a search";
  if (refined.stats) {
    refined.stats->alignment =
        alignment_stats(found->registration, guess.inverse() * refined.T_odom_lidar);
    refined.stats->vertical_fit = found->fit.share;
    refined.stats->covariance = pose_covariance(found->registration, kOpen);
  }
  return refined;
}

void PoseRefiner::keep(RegistrationCloud cloud_lidar, const RigidMotion& T_odom_lidar) {
  local_map_.add(std::move(cloud_lidar.points), T_odom_lidar);
}

}  // namespace fovea
