#include "fovea/mapping/fusion/loop_closure.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/fusion/place_match.h"

namespace fovea {
namespace {

constexpr float kVoxel = 0.5;     // m
constexpr float kMaxRange = 60;   // m
constexpr double kMinPath = 40;   // m: the local map covers later submaps
constexpr double kReach = 12;     // m, between two scans of one place
constexpr double kDrift = 0.01;   // largest share of the path
constexpr double kMaxDrift = 25;  // m
constexpr std::size_t kMaxAttempts = 2;

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
  const RigidMotion guess_T_scan_lidar = scan.T_submap_lidar.inverse() * candidate.T_submap_lidar;
  const auto match = match_place(target, index, cloud_lidar, guess_T_scan_lidar, registration_);
  if (!match) return std::nullopt;
  const RigidMotion T_submap_lidar = scan.T_submap_lidar * match->T_target_source;
  const double moved =
      (T_submap_lidar.translation() - candidate.T_submap_lidar.translation()).norm();
  if (moved > kPlaceReach + drift_of(candidate)) return std::nullopt;
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
  // Sorts by distance, then by index. std::stable_sort does not align its buffer as motions require
  // (libstdc++ 12).
  std::vector<std::pair<double, std::size_t>> nearest;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    nearest.emplace_back(distance(candidates[i]), i);
  }
  std::sort(nearest.begin(), nearest.end());
  nearest.resize(std::min(nearest.size(), kMaxAttempts));
  const RegistrationCloud cloud = thin(points_lidar, registration_);
  for (const auto& [away, i] : nearest) {
    if (auto closure = verify(cloud, candidates[i])) return closure;
  }
  return std::nullopt;
}

}  // namespace fovea
