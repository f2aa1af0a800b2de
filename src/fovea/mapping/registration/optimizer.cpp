#include "fovea/mapping/registration/optimizer.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace fovea {
namespace {

/// Steps on one set of pairs. The pairs change afterwards, so more steps have little effect.
constexpr int kMaxSteps = 3;
/// Damping, relative to the information of a fully observed direction.
constexpr double kFirstDamping = 1e-4;
constexpr double kMaxDamping = 1e3;

/// Eigenvectors of the information, and which of them are observed.
struct Directions {
  Eigen::Matrix<double, 6, 6> vectors;   // columns; a radian is kRotationArm meters
  Eigen::Matrix<double, 6, 1> observed;  // 1 or 0
  int degenerate = 0;
};

Twist unit_scale() {
  Twist scale = Twist::Ones();
  scale.head<3>().setConstant(1 / kRotationArm);
  return scale;
}

Directions observed_directions(const PairEquations& equations, const OptimizerOptions& options) {
  const Twist scale = unit_scale();
  const Eigen::Matrix<double, 6, 6> evidence =
      scale.asDiagonal() * (options.judge_by_planes ? equations.H_planes : equations.H) *
      scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(evidence);
  Directions directions;
  directions.vectors = solver.eigenvectors();
  const double least = options.degenerate_eigenvalue * equations.weight;
  for (int i = 0; i < 6; ++i) {
    const bool observed = solver.eigenvalues()[i] > least;
    directions.observed[i] = observed ? 1 : 0;
    directions.degenerate += observed ? 0 : 1;
  }
  return directions;
}

/// The prior as normal equations in the units of pairs.
class PriorTerm {
 public:
  /// @param equations  of the pairs at the first guess
  PriorTerm(const std::optional<PosePrior>& prior, const PairEquations& equations) {
    if (!prior || equations.weight == 0) return;
    T_source_target_ = prior->T_target_source.inverse();
    const double variance = std::max(equations.error / equations.weight, kLeastVariance);
    weight_ =
        variance * equations.weight / kIndependentPairs * prior->sigma.cwiseAbs2().cwiseInverse();
  }

  bool exists() const { return !weight_.isZero(0); }
  /// The diagonal of H.
  const Twist& weight() const { return weight_; }
  Twist b(const RigidMotion& T_target_source) const {
    return weight_.cwiseProduct(difference(T_target_source));
  }
  double error(const RigidMotion& T_target_source) const {
    return exists() ? difference(T_target_source).dot(b(T_target_source)) : 0;
  }

 private:
  Twist difference(const RigidMotion& T_target_source) const {
    return log_se3(T_source_target_ * T_target_source);
  }

  static constexpr double kIndependentPairs = 100;
  static constexpr double kLeastVariance = 4e-4;  // m^2, of a pair's distance
  RigidMotion T_source_target_ = RigidMotion::Identity();
  Twist weight_ = Twist::Zero();
};

/// Solves (H + damping) step = -b. Pairs contribute in observed directions only, the prior in all.
Twist solve(const PairEquations& equations, const PriorTerm& prior, const RigidMotion& T,
            const Directions& directions, double damping) {
  const Twist scale = unit_scale();
  const Eigen::Matrix<double, 6, 6>& V = directions.vectors;
  Eigen::Matrix<double, 6, 6> H =
      V.transpose() * scale.asDiagonal() * equations.H * scale.asDiagonal() * V;
  Twist b = V.transpose() * (scale.asDiagonal() * equations.b);
  for (int i = 0; i < 6; ++i) {
    if (directions.observed[i] == 0) {
      H.row(i).setZero();
      H.col(i).setZero();
      b[i] = 0;
      H(i, i) = prior.exists() ? 0 : 1;
    }
  }
  if (prior.exists()) {
    const Twist weight = scale.cwiseAbs2().cwiseProduct(prior.weight());
    H += V.transpose() * weight.asDiagonal() * V;
    b += V.transpose() * (scale.asDiagonal() * prior.b(T));
  }
  H.diagonal().array() += damping * equations.weight;
  return scale.asDiagonal() * (V * H.ldlt().solve(-b));
}

}  // namespace

RigidMotion moved_by(const RigidMotion& T, const Twist& step) {
  RigidMotion moved = T * exp_se3(step);
  moved.linear() = nearest_rotation(moved.linear());
  return moved;
}

OptimizerResult minimize(const PairBlocks& pairs, const RigidMotion& guess,
                         const OptimizerOptions& options) {
  OptimizerResult best{guess, 0, accumulate(pairs, guess, options.robust_width)};
  const PriorTerm prior(options.prior, best.equations);
  double best_error = best.equations.error + prior.error(guess);
  Directions directions = observed_directions(best.equations, options);
  best.degenerate_directions = directions.degenerate;
  double damping = 0;
  for (int step_count = 0; step_count < kMaxSteps && damping <= kMaxDamping;) {
    const Twist step = solve(best.equations, prior, best.T_target_source, directions, damping);
    if (!step.allFinite()) break;
    const RigidMotion T = moved_by(best.T_target_source, step);
    PairEquations equations = accumulate(pairs, T, options.robust_width);
    const double error = equations.error + prior.error(T);
    if (!(error <= best_error)) {
      if (options.converged.contains(step)) break;
      damping = std::max(kFirstDamping, damping * 10);
      continue;
    }
    best.T_target_source = T;
    best.equations = std::move(equations);
    best_error = error;
    directions = observed_directions(best.equations, options);
    best.degenerate_directions = directions.degenerate;
    damping = damping > kFirstDamping ? damping / 10 : 0;
    ++step_count;
    if (options.converged.contains(step)) break;
  }
  return best;
}

}  // namespace fovea
