#include "fovea/merging/submap_match.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <map>
#include <memory>

#include "fovea/mapping/fusion/place_match.h"
#include "fovea/merging/common_space.h"
#include "fovea/merging/twist_adjoint.h"

namespace fovea {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kPartnerReach = 30;  // m between the middles of partners
constexpr std::size_t kKeptTargets = 24;
/// Standard deviations that the noise of pairs does not explain, as measured in a simulated town
/// (docs/city.md). Heading is better known than tilt, and place than height: rad, m.
const Twist kLeastSigma = (Twist() << 1e-3, 1e-3, 3e-4, 0.005, 0.005, 0.01).finished();
/// Neighboring pairs have common errors: this many count as one.
constexpr double kCorrelatedPairs = 20;

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
      const std::vector<Eigen::Vector3f> points_b =
          b_.points_near(*middles_b_[k], kSubmapRadius, k);
      for (const std::size_t i : partners) match(i, k, points_b, guess_T_a_b, result);
    }
    return result;
  }

 private:
  const PlaceTarget& target(std::size_t submap) {
    auto& target = targets_[submap];
    if (!target) {
      const Eigen::Vector3d& middle = *middles_a_[submap];
      target = std::make_unique<PlaceTarget>(
          a_.points_near(middle, kSubmapRadius + kPlaceReach, submap), middle);
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
    const PlaceTarget& target = this->target(submap_a);
    const RigidMotion T_b_place(Eigen::Translation3d{*middles_b_[submap_b]});
    const RigidMotion guess = target.T_a_place.inverse() * guess_T_a_b * T_b_place;
    if (!has_common_space(target.plan, points_b, guess)) return;
    ++result.tried;
    const auto fit = fit_common_space(target, points_b, guess);
    if (!fit) return;
    const RigidMotion& T_target_b = fit->registration.T_target_source;
    guess_T_a_b = target.T_a_place * T_target_b * T_b_place.inverse();
    const PlaceFit quality = place_fit(target.cloud, target.index, fit->source, T_target_b);
    const RigidMotion& T_a_submap = a_.T_local_submap()[submap_a];
    const RigidMotion& T_b_submap = b_.T_local_submap()[submap_b];
    SubmapMatch match{.submap_a = submap_a, .submap_b = submap_b};
    match.T_a_b = T_a_submap.inverse() * guess_T_a_b * T_b_submap;
    const Matrix6 moved = adjoint(T_b_submap.inverse() * T_b_place);
    match.covariance = moved * covariance_of(fit->registration) * moved.transpose();
    match.overlap = quality.overlap;
    match.on_plane = quality.on_plane;
    result.matches.push_back(match);
  }

  SubmapScans &a_, &b_;
  std::vector<std::optional<Eigen::Vector3d>> middles_a_, middles_b_;
  std::map<std::size_t, std::unique_ptr<PlaceTarget>> targets_;
};

}  // namespace

SubmapMatches match_submaps(SubmapScans& a, const MapContent& content_a, SubmapScans& b,
                            const MapContent& content_b, const RigidMotion& guess_T_a_b) {
  return Matcher(a, content_a, b, content_b).run(guess_T_a_b);
}

}  // namespace fovea
