#include "fovea/pipeline/pose_refiner.h"

#include <fmt/format.h>

#include <numbers>

#include "fovea/geometry/transform_cloud.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/ground.h"
#include "fovea/mapping/registration/place_search.h"

namespace fovea {

double fit_of(const RegistrationResult& result, const RegistrationOptions& options) {
  const double away = result.rms_distance / options.max_distance;
  return static_cast<double>(result.pairs) * std::max(0.0, 1 - away * away);
}

namespace {

/// Share of a scan's points that have a counterpart, below which the scan is elsewhere: even after
/// 14 m of a street, 0.7 of them have one.
constexpr double kLeastOverlap = 0.3;

std::optional<NormalOptions> target_normals(const RefinementOptions& options) {
  if (options.registration.method == RegistrationMethod::kPointToPoint) return std::nullopt;
  return NormalOptions{.neighbors = options.registration.neighbors,
                       .range_noise = options.range_noise};
}

}  // namespace

PoseRefiner::PoseRefiner(const RefinementOptions& options, std::vector<Camera> cameras)
    : options_(options),
      cameras_(std::move(cameras)),
      local_map_(options.local_map, target_normals(options)) {}

Keyframes PoseRefiner::keyframes() const {
  if (options_.target == RegistrationTarget::kPreviousScan) return Keyframes({});
  const LocalMapOptions& map = options_.local_map;
  return Keyframes({map.keyframe_distance, map.keyframe_rotation, map.keyframe_overlap});
}

int PoseRefiner::memory() const {
  return options_.target == RegistrationTarget::kPreviousScan
             ? 1
             : LocalMap::memory(options_.local_map);
}

PointCloud PoseRefiner::visible_upsampled(const PointCloud& scan_lidar) const {
  const std::vector<std::uint8_t> ground = segment_ground(scan_lidar.position, options_.ground);
  const UpsampleOptions upsampling{.rate = options_.upsample_rate, .max_edge = options_.max_edge};
  std::vector<std::uint8_t> taken(scan_lidar.size(), 0);
  PointCloud result;
  for (const Camera& camera : cameras_) {
    // A point that several cameras see is upsampled in the first one's view.
    const PointCloud points_cam = transform_cloud(scan_lidar, camera.T_cam_lidar);
    std::vector<std::uint32_t> ground_in_view, rest_in_view;
    for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
      const auto pixel = camera.project(points_cam.position[i].cast<double>());
      if (taken[i] != 0 || !pixel || !camera.in_view(*pixel)) continue;
      taken[i] = 1;
      (ground[i] != 0 ? ground_in_view : rest_in_view).push_back(i);
    }
    const PointCloud dense = upsample(points_cam.select(rest_in_view), camera, upsampling);
    const PointCloud dense_lidar = transform_cloud(dense, camera.T_cam_lidar.inverse());
    for (const std::uint32_t i : ground_in_view) result.position.push_back(scan_lidar.position[i]);
    result.position.insert(result.position.end(), dense_lidar.position.begin(),
                           dense_lidar.position.end());
  }
  if (options_.visible_only) return result;
  for (std::size_t i = 0; i < scan_lidar.size(); ++i) {
    if (taken[i] == 0) result.position.push_back(scan_lidar.position[i]);
  }
  return result;
}

RegistrationCloud PoseRefiner::prepare(const PointCloud& scan_lidar, StageClock& clock) const {
  const bool whole = !options_.visible_only && options_.upsample_rate == 0;
  PointCloud dense;
  if (!whole) dense = clock.time("upsample", [&] { return visible_upsampled(scan_lidar); });
  const std::vector<Eigen::Vector3f>& points = whole ? scan_lidar.position : dense.position;
  // The local map has planes of its own.
  const bool needs_normals = options_.target == RegistrationTarget::kPreviousScan ||
                             options_.registration.method == RegistrationMethod::kGicp;
  return clock.time("register", [&] {
    auto thinned = voxel_thinned(points, static_cast<float>(options_.voxel));
    return needs_normals ? prepare_cloud(std::move(thinned), options_.registration, options_.voxel)
                         : select_points(std::move(thinned), options_.registration.max_points);
  });
}

RegistrationResult PoseRefiner::register_scan(const RegistrationCloud& source,
                                              const RigidMotion& guess,
                                              const std::optional<Twist>& sigma) const {
  if (options_.target == RegistrationTarget::kLocalMap) {
    std::optional<PosePrior> prior;
    if (sigma) prior = PosePrior{guess, *sigma};
    return register_to(local_map_, source, guess, options_.registration, prior);
  }
  const PointIndex index(previous_->cloud.points, options_.voxel);
  RegistrationResult result =
      register_clouds(previous_->cloud, index, source, previous_->T_odom_lidar.inverse() * guess,
                      options_.registration);
  result.T_target_source = previous_->T_odom_lidar * result.T_target_source;
  return result;
}

std::string PoseRefiner::objection_to(const RegistrationResult& result,
                                      const RigidMotion& correction,
                                      const std::optional<Twist>& sigma,
                                      const VerticalFit& fit) const {
  // Deviations of navigation by which a pose has to be confirmed.
  constexpr double kDoubtful = 5;
  const double moved = correction.translation().norm();
  const double turned = rotation_angle(correction.linear());
  if (!result.converged) return "registration did not converge, first guess kept";
  if (moved > options_.max_correction_translation || turned > options_.max_correction_rotation) {
    return fmt::format("registration moved {:.2f} m and {:.1f} degrees, first guess kept", moved,
                       turned * 180 / std::numbers::pi);
  }
  const bool is_doubtful = sigma && (moved > kDoubtful * sigma->tail<3>().maxCoeff() ||
                                     turned > kDoubtful * sigma->head<3>().maxCoeff());
  if (is_doubtful && fit.points < VerticalFit::kLeastPoints) {
    return fmt::format(
        "registration moved {:.2f} m off navigation and no wall confirms it, navigation kept",
        moved);
  }
  return "";
}

RefinedPose PoseRefiner::refine(const PointCloud& scan_lidar, const RigidMotion& guess,
                                StageClock& clock, const std::optional<Twist>& sigma) const {
  RefinedPose refined;
  refined.T_odom_lidar = guess;
  refined.cloud = prepare(scan_lidar, clock);
  refined.figures["registration_points"] = static_cast<double>(refined.cloud.points.size());

  const bool to_map = options_.target == RegistrationTarget::kLocalMap;
  if (to_map ? local_map_.empty() : !previous_.has_value()) return refined;
  const RegistrationResult result =
      clock.time("register", [&] { return register_scan(refined.cloud, guess, sigma); });
  const RigidMotion correction = guess.inverse() * result.T_target_source;
  VerticalFit fit;
  if (to_map) fit = vertical_fit(local_map_, refined.cloud, result.T_target_source);
  refined.note = objection_to(result, correction, sigma, fit);
  if (refined.note.empty()) {
    refined.T_odom_lidar = result.T_target_source;
    refined.fit = fit_of(result, options_.registration);
  } else if (to_map) {
    fit = vertical_fit(local_map_, refined.cloud, guess);
  }
  if (to_map) {
    const double overlap = double(result.pairs) / double(refined.cloud.points.size());
    refined.lost = fit.contradicts() || overlap < kLeastOverlap;
    refined.is_confirmed =
        refined.note.empty() && !refined.lost && place_score(fit, overlap) > kLeastPlaceScore;
    refined.figures["registration_vertical_fit"] = fit.share;
  }
  refined.figures["registration_iterations"] = result.iterations;
  refined.figures["registration_pairs"] = static_cast<double>(result.pairs);
  refined.figures["registration_rms"] = result.rms_distance;
  refined.figures["registration_degenerate"] = result.degenerate_directions;
  refined.figures["registration_failed"] = refined.note.empty() ? 0 : 1;
  refined.figures["correction_translation"] = correction.translation().norm();
  refined.figures["correction_rotation"] = rotation_angle(correction.linear());
  return refined;
}

RefinedPose PoseRefiner::search(RefinedPose lost, const RigidMotion& guess, double reach,
                                StageClock& clock) const {
  RefinedPose refined = std::move(lost);
  refined.T_odom_lidar = guess;
  refined.note = "the scan fits nowhere around its first guess";
  if (local_map_.empty()) return refined;
  const auto found = clock.time("register", [&] {
    return search_place(local_map_, refined.cloud, guess, reach, options_.registration);
  });
  if (!found) return refined;
  refined.lost = false;
  refined.is_confirmed = true;
  refined.T_odom_lidar = found->registration.T_target_source;
  refined.fit = fit_of(found->registration, options_.registration);
  refined.note = "the scan was found again by a search";
  refined.figures["registration_vertical_fit"] = found->fit.share;
  return refined;
}

void PoseRefiner::restart() {
  local_map_.clear();
  previous_.reset();
}

void PoseRefiner::keep(RegistrationCloud cloud_lidar, const RigidMotion& T_odom_lidar,
                       StageClock& clock) {
  clock.time("register", [&] {
    if (options_.target == RegistrationTarget::kLocalMap) {
      local_map_.add(std::move(cloud_lidar.points), T_odom_lidar);
    } else {
      previous_ = PreviousScan{std::move(cloud_lidar), T_odom_lidar};
    }
  });
}

}  // namespace fovea
