#include "fovea/merging/submap_match.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <map>
#include <memory>

#include "fovea/mapping/fusion/place_match.h"
#include "fovea/mapping/fusion/plan_view.h"
#include "fovea/merging/twist_adjoint.h"

namespace fovea {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kRadius = 50;           // m around the middle of a submap, that are registered
constexpr double kPartnerReach = 30;     // m between the middles of partners
constexpr std::size_t kMinPoints = 500;  // of B where A has some; fewer are no common space
constexpr std::size_t kKeptTargets = 24;
/// Standard deviations that the noise of pairs does not explain, as measured in a simulated town
/// (docs/city.md). Heading is better known than tilt, and place than height: rad, m.
const Twist kLeastSigma = (Twist() << 1e-3, 1e-3, 3e-4, 0.005, 0.005, 0.01).finished();
/// Neighboring pairs have common errors: this many count as one.
constexpr double kCorrelatedPairs = 20;

RegistrationOptions registration_options() {
  RegistrationOptions options;
  options.max_distance = 0.5;
  options.robust_width = 0.1;
  return options;
}

/// A submap of A around its middle, in the axes of local.
struct Target {
  Target(std::vector<Eigen::Vector3f> points, const Eigen::Vector3d& middle_a)
      : T_local_place(Eigen::Translation3d{middle_a}),
        plan(points),
        cloud(prepare_cloud(std::move(points), registration_options(), MapSurfaces::kVoxel)),
        index(cloud.points, MapSurfaces::kVoxel) {}

  RigidMotion T_local_place;
  PlanView plan;
  RegistrationCloud cloud;
  PointIndex index;
};

/// Up to `most` of the places, the nearest one first, then always the one that is farthest from
/// those chosen.
std::vector<std::size_t> spread(const std::vector<std::optional<Eigen::Vector3d>>& places,
                                const Eigen::Vector3d& center, double reach, std::size_t most) {
  std::vector<std::pair<double, std::size_t>> near;  // distance to those chosen, place
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] && (*places[i] - center).norm() < reach) near.emplace_back(0, i);
  }
  std::vector<std::size_t> chosen;
  while (chosen.size() < most && !near.empty()) {
    for (auto& [distance, i] : near) {
      distance =
          chosen.empty() ? -(*places[i] - center).norm() : std::numeric_limits<double>::infinity();
      for (const std::size_t k : chosen) {
        distance = std::min(distance, (*places[i] - *places[k]).norm());
      }
    }
    const auto best = std::max_element(
        near.begin(), near.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    chosen.push_back(best->second);
    near.erase(best);
  }
  return chosen;
}

Matrix6 covariance_of(const RegistrationResult& result) {
  Matrix6 covariance =
      kCorrelatedPairs * (result.information + 1e-9 * Matrix6::Identity()).inverse();
  covariance.diagonal() += kLeastSigma.cwiseAbs2();
  return covariance;
}

class Matcher {
 public:
  Matcher(SubmapScans& a, const MapContent& content_a, SubmapScans& b, const MapContent& content_b)
      : a_(a),
        b_(b),
        middles_a_(submap_middles(content_a.frames, content_a.T_local_submap.size())),
        middles_b_(submap_middles(content_b.frames, content_b.T_local_submap.size())) {}

  SubmapMatches run(RigidMotion guess_T_a_b) {
    SubmapMatches result;
    for (std::size_t k = 0; k < middles_b_.size(); ++k) {
      if (!middles_b_[k]) continue;
      const Eigen::Vector3d middle_a = guess_T_a_b * *middles_b_[k];
      const auto partners = spread(middles_a_, middle_a, kPartnerReach, kMostPartners);
      if (partners.empty()) continue;
      const std::vector<Eigen::Vector3f> points_b = b_.points_near(*middles_b_[k], kRadius, k);
      for (const std::size_t i : partners) match(i, k, points_b, guess_T_a_b, result);
    }
    return result;
  }

 private:
  const Target& target(std::size_t submap) {
    auto& target = targets_[submap];
    if (!target) {
      const Eigen::Vector3d& middle = *middles_a_[submap];
      target =
          std::make_unique<Target>(a_.points_near(middle, kRadius + kPlaceReach, submap), middle);
      while (targets_.size() > kKeptTargets) {
        targets_.erase(targets_.begin()->first == submap ? std::prev(targets_.end())
                                                         : targets_.begin());
      }
    }
    return *target;
  }

  /// Adds the match of two submaps if they fit, and improves the guess by it.
  void match(std::size_t submap_a, std::size_t submap_b,
             const std::vector<Eigen::Vector3f>& points_b, RigidMotion& guess_T_a_b,
             SubmapMatches& result) {
    const Target& target = this->target(submap_a);
    const RigidMotion T_b_place(Eigen::Translation3d{*middles_b_[submap_b]});
    const RigidMotion guess = target.T_local_place.inverse() * guess_T_a_b * T_b_place;
    if (target.plan.covered(points_b, guess, kPlaceReach).size() < kMinPoints) return;
    ++result.tried;
    const RegistrationOptions options = registration_options();
    std::optional<RegistrationResult> fit;
    RegistrationCloud source;
    for (int pass = 0; pass < 2; ++pass) {  // what both have shows once they lie right
      const RigidMotion& T = fit ? fit->T_target_source : guess;
      source = prepare_cloud(target.plan.covered(points_b, T, kPlaceReach), options,
                             MapSurfaces::kVoxel);
      fit = match_place(target.cloud, target.index, source, T, options);
      if (!fit) return;
    }
    if ((guess.inverse() * fit->T_target_source).translation().norm() > kPlaceReach) return;
    guess_T_a_b = target.T_local_place * fit->T_target_source * T_b_place.inverse();
    const PlaceFit quality = place_fit(target.cloud, target.index, source, fit->T_target_source);
    const RigidMotion& T_a_submap = a_.T_local_submap()[submap_a];
    const RigidMotion& T_b_submap = b_.T_local_submap()[submap_b];
    SubmapMatch match{.submap_a = submap_a, .submap_b = submap_b};
    match.T_a_b = T_a_submap.inverse() * guess_T_a_b * T_b_submap;
    const Matrix6 moved = adjoint(T_b_submap.inverse() * T_b_place);
    match.covariance = moved * covariance_of(*fit) * moved.transpose();
    match.overlap = quality.overlap;
    match.on_plane = quality.on_plane;
    result.matches.push_back(match);
  }

  SubmapScans &a_, &b_;
  std::vector<std::optional<Eigen::Vector3d>> middles_a_, middles_b_;
  std::map<std::size_t, std::unique_ptr<Target>> targets_;
};

}  // namespace

SubmapMatches match_submaps(SubmapScans& a, const MapContent& content_a, SubmapScans& b,
                            const MapContent& content_b, const RigidMotion& guess_T_a_b) {
  return Matcher(a, content_a, b, content_b).run(guess_T_a_b);
}

std::vector<std::optional<Eigen::Vector3d>> submap_middles(const std::vector<FrameRecord>& frames,
                                                           std::size_t submaps) {
  std::vector<std::vector<Eigen::Vector3d>> positions(submaps);
  for (const FrameRecord& frame : frames) {
    if (frame.submap < 0 || std::size_t(frame.submap) >= submaps) continue;
    positions[std::size_t(frame.submap)].push_back(frame.T_local_lidar.translation());
  }
  std::vector<std::optional<Eigen::Vector3d>> middles(submaps);
  for (std::size_t id = 0; id < submaps; ++id) {
    if (!positions[id].empty()) middles[id] = positions[id][positions[id].size() / 2];
  }
  return middles;
}

}  // namespace fovea
