#include "fovea/mapping/calibration/edge_maximum.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>

#include "fovea/mapping/calibration/grouped_scatter.h"

namespace fovea {
namespace {

using Vector = CalibrationVector;
using Matrix = CalibrationMatrix;

constexpr std::array<double, 5> kWidths{kCoarsestEdgeWidth, 4, 2, 1, kFinestEdgeWidth};
constexpr int kMaxIterations = 60;
constexpr double kConverged = 1e-3;   // pixels
constexpr double kNearEnough = 0.02;  // of a coarse Gaussian's width
// Standard deviation of an unknown delay (s), which biases a rotation that is estimated without it.
constexpr double kLikelyDelay = 0.02;

EdgeScore score_at(const std::vector<EdgeProfile>& profiles, const QuadraticTerm& evidence,
                   const Vector& x, double width) {
  EdgeScore score = edge_score(profiles, x, width);
  const Vector pull = evidence.curvature * x;
  score.value += evidence.gradient.dot(x) - x.dot(pull) / 2;
  score.gradient += evidence.gradient - pull;
  score.curvature += evidence.curvature;
  score.bound += evidence.curvature;
  return score;
}

}  // namespace

QuadraticTerm& QuadraticTerm::operator+=(const QuadraticTerm& other) {
  gradient += other.gradient;
  curvature += other.curvature;
  scatter += other.scatter;
  return *this;
}

QuadraticTerm QuadraticTerm::scaled(double weight) const {
  return {weight * gradient, weight * curvature, weight * weight * scatter};
}

Matrix decoupled(const FreeParameters& free, Matrix m) {
  const double largest = m.diagonal().maxCoeff();
  for (int k = 0; k < 9; ++k) {
    if (free[static_cast<std::size_t>(k)]) continue;
    m.row(k).setZero();
    m.col(k).setZero();
    m(k, k) = largest;
  }
  return m;
}

Matrix free_part(const FreeParameters& free, Matrix m) {
  for (int k = 0; k < 9; ++k) {
    if (free[static_cast<std::size_t>(k)]) continue;
    m.row(k).setZero();
    m.col(k).setZero();
  }
  return m;
}

Vector free_part(const FreeParameters& free, Vector v) {
  for (int k = 0; k < 9; ++k) {
    if (!free[static_cast<std::size_t>(k)]) v[k] = 0;
  }
  return v;
}

bool is_positive_definite(const Matrix& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(m, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] > 1e-6 * eigen.eigenvalues()[8];
}

/// Newton steps. If a step leads down or the score is not concave, the paraboloid below the score
/// gives the step instead. Its maximum never leads down.
Vector maximize_edge_score(const std::vector<EdgeProfile>& profiles, const FreeParameters& free,
                           const QuadraticTerm& evidence, double coarsest) {
  Vector x = Vector::Zero();
  for (const double width : kWidths) {
    if (width > coarsest) continue;
    const double converged = width == kWidths.back() ? kConverged : kNearEnough * width;
    EdgeScore score = score_at(profiles, evidence, x, width);
    for (int i = 0; i < kMaxIterations; ++i) {
      const Vector gradient = free_part(free, score.gradient);
      const Matrix curvature = decoupled(free, score.curvature),
                   bound = decoupled(free, score.bound);
      if (!(bound.diagonal().maxCoeff() > 0)) return x;  // nothing in sight
      std::optional<EdgeScore> next;
      Vector step = Vector::Zero();
      if (is_positive_definite(curvature)) {
        step = curvature.ldlt().solve(gradient);
        next = score_at(profiles, evidence, x + step, width);
        if (!(next->value >= score.value)) next.reset();
      }
      if (!next) {
        step = (bound + 1e-9 * bound.diagonal().maxCoeff() * Matrix::Identity())
                   .ldlt()
                   .solve(gradient);
      }
      x += step;
      if (step.norm() < converged) break;
      score = next ? *next : score_at(profiles, evidence, x, width);
    }
  }
  return x;
}

Matrix edge_scatter(const std::vector<EdgeProfile>& profiles, const FreeParameters& free,
                    const Vector& x, double width) {
  const auto gradient = [&](const EdgeProfile& profile) {
    return free_part(free, edge_score(profile, x, width).gradient);
  };
  return grouped_scatter(profiles, gradient, [](const EdgeProfile& p) { return p.frame; }) +
         grouped_scatter(profiles, gradient, [](const EdgeProfile& p) { return p.place; });
}

Matrix edge_covariance(const std::vector<EdgeProfile>& profiles, const FreeParameters& free,
                       const Vector& x, const Matrix& curvature) {
  const Matrix inverse = decoupled(free, curvature).inverse();
  Matrix result = inverse * edge_scatter(profiles, free, x) * inverse;
  if (!free[kCamDelay]) {
    const Vector turned = inverse * free_part(free, Vector(curvature.col(kCamDelay))) *
                          (kLikelyDelay / calibration_unit()[kCamDelay]);
    result += turned * turned.transpose();
  }
  return result;
}

}  // namespace fovea
