#include "fovea/mapping/registration/registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/mapping/registration/gicp_factor.h"
#include "fovea/mapping/registration/normals.h"
#include "fovea/mapping/registration/optimizer.h"
#include "fovea/mapping/registration/point_to_plane_factor.h"
#include "fovea/mapping/registration/point_to_point_factor.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 256;

/// Fewer pairs do not determine the six degrees of freedom reliably.
constexpr std::size_t kMinPairs = 50;

/// Indices of `count` items at even steps among `all`.
std::vector<std::uint32_t> even_sample(std::size_t count, std::size_t all) {
  std::vector<std::uint32_t> sample(std::min(count, all));
  for (std::size_t i = 0; i < sample.size(); ++i) {
    sample[i] = static_cast<std::uint32_t>(i * all / sample.size());
  }
  return sample;
}

/// @param max_points  0: all
std::vector<std::uint32_t> selected(std::size_t points, int max_points) {
  return even_sample(max_points > 0 ? static_cast<std::size_t>(max_points) : points, points);
}

/// The clouds of one registration.
struct Clouds {
  const RegistrationCloud& target;
  const PointIndex& target_index;
  const RegistrationCloud& source;
};

/// Pairs of `count` source points, without targets yet.
std::vector<Pair> pairs_of(const RegistrationCloud& source, std::size_t count) {
  std::vector<Pair> pairs;
  pairs.reserve(count);
  for (const std::uint32_t i : even_sample(count, source.points.size())) {
    Pair& pair = pairs.emplace_back();
    pair.source = source.points[i];
    if (!source.normals.empty()) pair.source_normal = source.normals[i];
  }
  return pairs;
}

/// Pairs a source point with the nearest target point. The pair gets no target if none is within
/// max_distance, or if the factor needs normals and both are unknown.
/// @param p  the source point at the present pose
/// @param R  rotation of the present pose
template <class Factor>
void find_pair(const Clouds& clouds, const Eigen::Vector3f& p, const Eigen::Matrix3f& R,
               const RegistrationOptions& options, Pair& pair) {
  pair.searched_at = p;
  pair.target_index = Pair::kNone;
  const Neighbor nearest = clouds.target_index.nearest(p, static_cast<float>(options.max_distance));
  if (!std::isfinite(nearest.squared_distance)) return;
  Eigen::Vector3f n = Eigen::Vector3f::Zero(), m = Eigen::Vector3f::Zero();
  if constexpr (Factor::kNeedsNormals) n = clouds.target.normals[nearest.index];
  if constexpr (Factor::kNeedsSourceNormals) m = R * pair.source_normal;
  if (Factor::kNeedsNormals && n.isZero() && m.isZero()) return;
  pair.target_index = nearest.index;
  pair.target = clouds.target.points[nearest.index];
  pair.normal = n;
  pair.information = Factor::information(n, m, options);
}

/// Updates all pairs for a pose, except those that the cache keeps.
/// @return number of searches
template <class Factor>
std::size_t find_pairs(const Clouds& clouds, const RigidMotion& T_target_source,
                       const RegistrationOptions& options, const PairCache& cache,
                       std::vector<Pair>& pairs) {
  const Eigen::Matrix3f R = T_target_source.linear().cast<float>();
  const Eigen::Vector3f t = T_target_source.translation().cast<float>();
  return parallel_sum(pairs.size(), kGrain, std::size_t{0},
                      [&](std::size_t begin, std::size_t end) {
                        std::size_t searches = 0;
                        for (std::size_t i = begin; i < end; ++i) {
                          const Eigen::Vector3f p = R * pairs[i].source + t;
                          if (cache.is_valid(pairs[i], p)) continue;
                          find_pair<Factor>(clouds, p, R, options, pairs[i]);
                          ++searches;
                        }
                        return searches;
                      });
}

/// Statistics of the last round.
template <class Factor>
void set_statistics(const OptimizerResult& solution, RegistrationResult& result) {
  const PairEquations& equations = solution.equations;
  result.degenerate_directions = solution.degenerate_directions;
  result.rms_distance =
      std::sqrt(equations.squared_distance / static_cast<double>(equations.pairs));
  // The scatter of the pairs gives the variance of one pair.
  const double error = std::max(equations.error, std::numeric_limits<double>::min());
  result.information =
      (Factor::kNeedsNormals ? equations.H_planes : equations.H) * (equations.weight / error);
}

/// Iterative closest point. Each round pairs source points p_i with target points q_i and minimizes
///   E(T) = sum_i rho(d_i^T M_i d_i) + e^T W e,  d_i = T p_i - q_i,  e = log(T_prior^-1 T).
/// W is the weight of the prior, zero without one. M_i is the factor's information matrix:
///   point to point  M_i = I                              (Besl, McKay 1992)
///   point to plane  M_i = n_i n_i^T                      (Chen, Medioni 1992)
///   GICP            M_i = (C_i^B + R C_i^A R^T)^-1       (Segal, Haehnel, Thrun 2009, Sec. III)
/// rho is the Geman-McClure kernel, or the identity without a robust width.
template <class Factor>
RegistrationResult align(const Clouds& clouds, const RigidMotion& guess,
                         const RegistrationOptions& options,
                         const std::optional<PosePrior>& prior) {
  const RegistrationPolicies& policies = options.policies;
  // A kernel as wide as max_distance does not narrow. The plain loop suffices then.
  const bool is_robust = options.robust_width > 0 && options.robust_width < options.max_distance;
  const StepLimit limit{options.converged_rotation, options.converged_translation};
  const NarrowingKernel kernel(policies.narrowing_kernel, options.max_distance,
                               options.robust_width);
  CoarsePhase coarse(policies.coarse_phase && is_robust, clouds.source.points.size());
  AitkenAcceleration acceleration(policies.aitken_acceleration && is_robust, limit);
  OptimizerOptions optimizer_options{.degenerate_eigenvalue = options.degenerate_eigenvalue,
                                     .judge_by_planes = Factor::kNeedsNormals,
                                     .converged = limit,
                                     .prior = prior};

  std::vector<Pair> pairs = pairs_of(clouds.source, coarse.points());
  RegistrationResult result{.T_target_source = guess};
  RigidMotion& T = result.T_target_source;
  while (!result.converged && result.iterations < options.max_iterations) {
    const int round = result.iterations++;

    // Find pairs: q_i is the target point nearest to T p_i.
    const PairCache cache(policies.pair_cache, Factor::kMaxPairMove, result.rms_distance);
    result.searches += find_pairs<Factor>(clouds, T, options, cache, pairs);

    // Linearize and solve: Levenberg-Marquardt steps on E (optimizer.h).
    optimizer_options.robust_width = kernel.width(round);
    const OptimizerResult solution = minimize(PairBlocks(pairs), T, optimizer_options);
    result.pairs = solution.equations.pairs;
    if (result.pairs < kMinPairs) {
      // rms_distance and information stay those of the round before. The report shows rms_distance.
      T = guess;
      result.degenerate_directions = 6;
      return result;
    }

    // Converged?
    const Twist step = log_se3(T.inverse() * solution.T_target_source);
    const bool is_final = kernel.is_final(round);
    result.converged = is_final && !coarse.is_active() && limit.contains(step);

    // Update. Steps form a series only after the kernel has its final width. The last round is not
    // accelerated: no later round would correct the pose.
    const double factor = is_final ? acceleration.factor(step) : 1;
    const bool accelerates = factor > 1 && result.iterations < options.max_iterations;
    T = accelerates ? moved_by(T, factor * step) : solution.T_target_source;
    set_statistics<Factor>(solution, result);
    const bool next_has_final_kernel = kernel.is_final(round + 1);
    if (next_has_final_kernel && coarse.end_if_due(step, result.iterations, limit)) {
      pairs = pairs_of(clouds.source, coarse.points());
    }
  }
  return result;
}

}  // namespace

RegistrationCloud select_points(std::vector<Eigen::Vector3f> points, int max_points) {
  std::erase_if(points, [](const Eigen::Vector3f& p) { return !p.allFinite(); });
  RegistrationCloud cloud;
  for (const std::uint32_t i : selected(points.size(), max_points)) {
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
  const std::vector<std::uint32_t> chosen = selected(points.size(), options.max_points);
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
  const Clouds clouds{target, target_index, source};
  switch (options.method) {
    case RegistrationMethod::kGicp:
      return align<GicpFactor>(clouds, guess, options, prior);
    case RegistrationMethod::kPointToPoint:
      return align<PointToPointFactor>(clouds, guess, options, prior);
    case RegistrationMethod::kPointToPlane:
      return align<PointToPlaneFactor>(clouds, guess, options, prior);
  }
  throw std::invalid_argument("unknown registration method");
}

}  // namespace fovea
