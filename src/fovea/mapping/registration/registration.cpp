#include "fovea/mapping/registration/registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/mapping/registration/gicp_factor.h"
#include "fovea/mapping/registration/normals.h"
#include "fovea/mapping/registration/optimizer.h"
#include "fovea/mapping/registration/point_to_plane_factor.h"
#include "fovea/mapping/registration/point_to_point_factor.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 256;

/// A pair is looked for again once its points have moved by this share of how far pairs are apart.
constexpr double kKeepsPairShare = 0.1;

/// How many points say enough of where to go while the kernel is wide, and until they move less
/// than kNearlyThere times what ends the iteration. Should they not agree on a place, all are asked
/// after so many rounds.
constexpr std::size_t kCoarsePoints = 2000;
constexpr double kNearlyThere = 20;
constexpr int kCoarseRounds = 30;

/// Steps by which a scan that lies off creeps along a road: under a narrow kernel the few pairs
/// that are right already draw it, a little at a time.
class CreepingSteps {
 public:
  /// How many of the latest step to take at once: as many as follow it if steps go on as they do
  /// (Aitken's extrapolation), and one where it has another direction than the one before.
  double take(const Twist& step) {
    const Eigen::Vector3d now = step.tail<3>(), before = std::exchange(last_, now);
    const double along = now.dot(before);
    // Back again: it went too far, and must not do so for ever.
    if (along < 0) most_ = std::max(1.0, most_ * kFewer);
    if (along <= kSameDirection * now.norm() * before.norm()) return 1;
    const double ratio = now.norm() / before.norm();
    return ratio < 1 ? std::min(most_, 1 / (1 - ratio)) : most_;
  }

 private:
  static constexpr double kSameDirection = 0.9;  // cosine
  static constexpr double kFewer = 0.75;
  double most_ = 4;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
};

/// Steps of less than so many times what ends the iteration do not creep.
constexpr double kCreeps = 5;

/// Fewer pairs than this are no evidence of six numbers.
constexpr std::size_t kMinPairs = 50;

/// Item i of `some` that stand at even steps among `all`.
std::size_t at_even_step(std::size_t i, std::size_t some, std::size_t all) {
  return i * all / some;
}

/// Indices of at most max_points of so many points (0: all of them), at even steps.
std::vector<std::uint32_t> chosen_of(std::size_t points, int max_points) {
  const std::size_t most =
      max_points > 0 ? std::min(static_cast<std::size_t>(max_points), points) : points;
  std::vector<std::uint32_t> chosen(most);
  for (std::size_t i = 0; i < most; ++i) {
    chosen[i] = static_cast<std::uint32_t>(at_even_step(i, most, points));
  }
  return chosen;
}

/// Gives each source point its nearest target point and the factor's weight of the two. A pair is
/// kept while its source point moves by less than `keep_within` (m); otherwise it bounds the
/// search, which then ends early.
/// @param pairs  of source points at even steps
template <class Factor>
void find_pairs(const RegistrationCloud& target, const PointIndex& target_index,
                const RegistrationCloud& source, const RigidMotion& T_target_source,
                const RegistrationOptions& options, float keep_within, std::vector<Pair>& pairs) {
  const Eigen::Matrix3f R = T_target_source.linear().cast<float>();
  const Eigen::Vector3f t = T_target_source.translation().cast<float>();
  const float max_distance = static_cast<float>(options.max_distance);
  parallel_for(pairs.size(), kGrain, [&](std::size_t i) {
    Pair& pair = pairs[i];
    const Eigen::Vector3f p = R * pair.source + t;
    if ((p - pair.looked_at).squaredNorm() < keep_within * keep_within) return;
    pair.looked_at = p;
    float bound = max_distance;
    if (pair.target_index != Pair::kNone) {
      // A little wider, so that rounding does not lose the previous neighbour itself.
      bound = std::min(bound, (p - pair.target).norm() * 1.001f + 1e-4f);
    }
    const Neighbor nearest = target_index.nearest(p, bound);
    pair.target_index = Pair::kNone;
    if (!std::isfinite(nearest.squared_distance)) return;
    Eigen::Vector3f n = Eigen::Vector3f::Zero(), m = Eigen::Vector3f::Zero();
    if constexpr (Factor::kNeedsNormals) {
      n = target.normals[nearest.index];
      if constexpr (Factor::kNeedsSourceNormals) {
        m = R * source.normals[at_even_step(i, pairs.size(), source.points.size())];
      }
      if (n.isZero() && m.isZero()) return;
    }
    pair.target_index = nearest.index;
    pair.target = target.points[nearest.index];
    pair.information = Factor::information(n, m, options);
    pair.normal = n;
  });
}

/// Pairs of at most so many source points, as yet without target.
std::vector<Pair> pairs_of(const RegistrationCloud& source, std::size_t most) {
  std::vector<Pair> pairs(std::min(most, source.points.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].source = source.points[at_even_step(i, pairs.size(), source.points.size())];
  }
  return pairs;
}

template <class Factor>
RegistrationResult align(const RegistrationCloud& target, const PointIndex& target_index,
                         const RegistrationCloud& source, const RigidMotion& guess,
                         const RegistrationOptions& options,
                         const std::optional<PosePrior>& prior) {
  OptimizerOptions optimizer{options.robust_width,          options.degenerate_eigenvalue,
                             Factor::kNeedsNormals,         options.converged_rotation,
                             options.converged_translation, prior};
  const bool narrows = options.robust_width > 0 && options.robust_width < options.max_distance;
  std::vector<Pair> pairs = pairs_of(source, narrows ? kCoarsePoints : source.points.size());

  RegistrationResult result;
  result.T_target_source = guess;
  bool nearly_there = false;
  CreepingSteps creeping;
  while (result.iterations < options.max_iterations && !result.converged) {
    // The kernel narrows step by step: from a poor guess the true pairs are far apart, too.
    if (options.robust_width > 0) {
      optimizer.robust_width =
          std::max(options.robust_width, std::ldexp(options.max_distance, -result.iterations));
    }
    const bool narrow = optimizer.robust_width <= options.robust_width;
    if (narrow && (nearly_there || result.iterations >= kCoarseRounds) &&
        pairs.size() < source.points.size()) {
      pairs = pairs_of(source, source.points.size());
    }
    const auto keep_within =
        static_cast<float>(std::min(Factor::kKeepsPairFor, kKeepsPairShare * result.rms_distance));
    find_pairs<Factor>(target, target_index, source, result.T_target_source, options, keep_within,
                       pairs);
    auto [T, degenerate, equations] =
        minimize(PairBlocks(pairs), result.T_target_source, optimizer);
    ++result.iterations;
    result.pairs = equations.pairs;
    if (equations.pairs < kMinPairs) {
      result.T_target_source = guess;
      result.degenerate_directions = 6;
      return result;
    }
    const Twist step = log_se3(result.T_target_source.inverse() * T);
    const auto moves_less_than = [&](double times) {
      return step.head<3>().norm() < times * options.converged_rotation &&
             step.tail<3>().norm() < times * options.converged_translation;
    };
    nearly_there = moves_less_than(kNearlyThere);
    result.converged = narrow && pairs.size() == source.points.size() && moves_less_than(1);
    if (narrows && narrow) {
      const double steps = creeping.take(step);
      // Not the last time: nobody would look whether it fits there.
      if (steps > 1 && !moves_less_than(kCreeps) && result.iterations < options.max_iterations) {
        T = result.T_target_source * exp_se3(steps * step);
        T.linear() = nearest_rotation(T.linear());
      }
    }
    result.T_target_source = T;
    result.degenerate_directions = degenerate;
    result.rms_distance =
        std::sqrt(equations.squared_distance / static_cast<double>(equations.pairs));
    // The pairs' own scatter says how much one of them is worth.
    result.information =
        (Factor::kNeedsNormals ? equations.H_planes : equations.H) *
        (equations.weight / std::max(equations.error, std::numeric_limits<double>::min()));
  }
  return result;
}

}  // namespace

void RegistrationOptions::validate() const {
  const auto reject = [](const char* what, const char* field, const char* remedy) {
    throw ConfigError(what, field, remedy);
  };
  if (max_iterations < 1 || max_iterations > 1000) {
    reject("an iteration limit is out of range", "registration.max_iterations", "give 1 to 1000");
  }
  if (max_points < 0 || max_points > 10'000'000) {
    reject("a number of points is out of range", "registration.max_points",
           "give 0 (all) or a number up to 10000000");
  }
  if (!(max_distance > 0 && max_distance <= 100)) {
    reject("a pair distance is out of range", "registration.max_distance",
           "give metres above 0 and up to 100");
  }
  if (!(converged_rotation > 0 && converged_rotation < 1)) {
    reject("a threshold is out of range", "registration.converged_rotation",
           "give radians above 0 and below 1");
  }
  if (!(converged_translation > 0 && converged_translation < 10)) {
    reject("a threshold is out of range", "registration.converged_translation",
           "give metres above 0 and below 10");
  }
  if (neighbors < 4 || neighbors > 100) {
    reject("a neighbour count is out of range", "registration.neighbors", "give 4 to 100");
  }
  if (!(plane_epsilon > 0 && plane_epsilon <= 1)) {
    reject("a regularisation is out of range", "registration.plane_epsilon",
           "give a ratio above 0 and up to 1");
  }
  if (!(robust_width >= 0 && robust_width <= 100)) {
    reject("a kernel width is out of range", "registration.robust_width",
           "give metres from 0 (off) to 100");
  }
  if (!(degenerate_eigenvalue >= 0 && degenerate_eigenvalue < 1)) {
    reject("a threshold is out of range", "registration.degenerate_eigenvalue",
           "give a number from 0 (off) to below 1");
  }
}

RegistrationCloud select_points(std::vector<Eigen::Vector3f> points, int max_points) {
  std::erase_if(points, [](const Eigen::Vector3f& p) { return !p.allFinite(); });
  RegistrationCloud cloud;
  for (const std::uint32_t i : chosen_of(points.size(), max_points)) {
    cloud.points.push_back(points[i]);
  }
  return cloud;
}

RegistrationCloud prepare_cloud(std::vector<Eigen::Vector3f> points,
                                const RegistrationOptions& options, double spacing) {
  if (options.method == RegistrationMethod::kPointToPoint) {
    return select_points(std::move(points), options.max_points);
  }
  std::erase_if(points, [](const Eigen::Vector3f& p) { return !p.allFinite(); });
  const std::vector<std::uint32_t> chosen = chosen_of(points.size(), options.max_points);
  RegistrationCloud cloud;
  cloud.normals = estimate_normals(points, chosen, {options.neighbors, spacing});
  cloud.points.reserve(chosen.size());
  for (const std::uint32_t i : chosen) cloud.points.push_back(points[i]);
  return cloud;
}

RegistrationResult register_clouds(const RegistrationCloud& target, const PointIndex& target_index,
                                   const RegistrationCloud& source, const RigidMotion& guess,
                                   const RegistrationOptions& options,
                                   const std::optional<PosePrior>& prior) {
  switch (options.method) {
    case RegistrationMethod::kGicp:
      return align<GicpFactor>(target, target_index, source, guess, options, prior);
    case RegistrationMethod::kPointToPoint:
      return align<PointToPointFactor>(target, target_index, source, guess, options, prior);
    case RegistrationMethod::kPointToPlane:
      return align<PointToPlaneFactor>(target, target_index, source, guess, options, prior);
  }
  throw std::invalid_argument("unknown registration method");
}

}  // namespace fovea
