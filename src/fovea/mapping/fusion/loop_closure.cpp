#include "fovea/mapping/fusion/loop_closure.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fovea/geometry/voxel_grid.h"

namespace fovea {
namespace {

constexpr float kVoxel = 0.5;     // m
constexpr float kMaxRange = 60;   // m
constexpr double kMinPath = 40;   // m: nearer in time, the local map knows the place
constexpr double kReach = 12;     // m: how far apart two scans of one place may be taken
constexpr double kDrift = 0.01;   // of the path, at most: where odometry may have strayed
constexpr double kMaxDrift = 25;  // m
constexpr std::size_t kMaxAttempts = 2;
/// Of the points that stand on something, at least this share must lie on its plane, and so many
/// must have a counterpart at all. Ground alone fits anywhere.
constexpr double kMinFit = 0.7, kMinOverlap = 0.6;
constexpr float kFlat = 0.7f;          // vertical part of the normal of ground
constexpr float kOnPlane = 0.1f;       // m
constexpr float kPairDistance = 1;     // m
constexpr double kCoarseDistance = 5;  // m, pairs of the first attempt

double drift_of(const LoopCandidate& candidate) {
  return std::min(kMaxDrift, kDrift * candidate.path);
}

RegistrationCloud thin(const std::vector<Eigen::Vector3f>& points,
                       const RegistrationOptions& options) {
  std::vector<Eigen::Vector3f> near;
  std::copy_if(points.begin(), points.end(), std::back_inserter(near),
               [](const Eigen::Vector3f& p) { return p.squaredNorm() <= kMaxRange * kMaxRange; });
  return prepare_cloud(voxel_thinned(std::move(near), kVoxel), options, kVoxel);
}

struct Fit {
  double overlap = 0;   // share of the points with a counterpart, ground apart
  double on_plane = 0;  // of those, share on their counterpart's plane
};

Fit fit_of(const RegistrationCloud& target, const PointIndex& index,
           const RegistrationCloud& source, const RigidMotion& T_target_source) {
  const Eigen::Matrix3f R = T_target_source.linear().cast<float>();
  const Eigen::Vector3f t = T_target_source.translation().cast<float>();
  std::size_t standing = 0, paired = 0, on_plane = 0;
  for (std::size_t i = 0; i < source.points.size(); ++i) {
    if (source.normals[i].isZero() || std::abs(source.normals[i].z()) > kFlat) continue;
    ++standing;
    const Eigen::Vector3f p = R * source.points[i] + t;
    const Neighbor nearest = index.nearest(p, kPairDistance);
    if (!std::isfinite(nearest.squared_distance)) continue;
    ++paired;
    const Eigen::Vector3f& normal = target.normals[nearest.index];
    const float away = normal.dot(p - target.points[nearest.index]);
    on_plane += !normal.isZero() && std::abs(away) < kOnPlane;
  }
  const auto share = [](std::size_t part, std::size_t of) {
    return of > 0 ? double(part) / double(of) : 0;
  };
  return {share(paired, standing), share(on_plane, paired)};
}

}  // namespace

LoopCloser::LoopCloser(const RegistrationOptions& registration) : registration_(registration) {
  registration_.method = RegistrationMethod::kGicp;  // the test of a closure needs normals
}

void LoopCloser::add(std::size_t submap, const std::vector<Eigen::Vector3f>& points_lidar,
                     const RigidMotion& T_submap_lidar) {
  const RegistrationCloud cloud_lidar = thin(points_lidar, registration_);
  scans_.insert_or_assign(submap, Scan{clouds_.append(cloud_lidar.points),
                                       clouds_.append(cloud_lidar.normals), T_submap_lidar});
}

std::optional<LoopClosure> LoopCloser::verify(const RegistrationCloud& cloud_lidar,
                                              const LoopCandidate& candidate) const {
  const Scan& scan = scans_.at(candidate.submap);
  const RegistrationCloud target{clouds_.read<Eigen::Vector3f>(scan.points),
                                 clouds_.read<Eigen::Vector3f>(scan.normals)};
  const PointIndex index(target.points, kVoxel);
  RigidMotion T_scan_lidar = scan.T_submap_lidar.inverse() * candidate.T_submap_lidar;
  RegistrationResult result;
  for (const double distance :
       {std::max(kCoarseDistance, registration_.max_distance), registration_.max_distance}) {
    RegistrationOptions options = registration_;
    options.max_distance = distance;
    result = register_clouds(target, index, cloud_lidar, T_scan_lidar, options);
    if (!result.converged || result.degenerate_directions > 0) return std::nullopt;
    T_scan_lidar = result.T_target_source;
  }
  const RigidMotion T_submap_lidar = scan.T_submap_lidar * T_scan_lidar;
  const double moved =
      (T_submap_lidar.translation() - candidate.T_submap_lidar.translation()).norm();
  const Fit fit = fit_of(target, index, cloud_lidar, T_scan_lidar);
  if (fit.overlap < kMinOverlap || fit.on_plane < kMinFit) return std::nullopt;
  if (moved > kCoarseDistance + drift_of(candidate)) return std::nullopt;
  return LoopClosure{candidate.submap, T_submap_lidar};
}

std::optional<LoopClosure> LoopCloser::find(const std::vector<Eigen::Vector3f>& points_lidar,
                                            std::vector<LoopCandidate> candidates) const {
  const auto distance = [&](const LoopCandidate& c) {
    return (scans_.at(c.submap).T_submap_lidar.inverse() * c.T_submap_lidar).translation().norm();
  };
  std::erase_if(candidates, [&](const LoopCandidate& c) {
    return !has(c.submap) || c.path < kMinPath || distance(c) > kReach + drift_of(c);
  });
  if (candidates.empty()) return std::nullopt;
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [&](const LoopCandidate& a, const LoopCandidate& b) { return distance(a) < distance(b); });
  candidates.resize(std::min(candidates.size(), kMaxAttempts));
  const RegistrationCloud cloud = thin(points_lidar, registration_);
  for (const LoopCandidate& candidate : candidates) {
    if (auto closure = verify(cloud, candidate)) return closure;
  }
  return std::nullopt;
}

}  // namespace fovea
