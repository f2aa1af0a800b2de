#include "fovea/mapping/fusion/pose_graph.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace fovea {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kMaxIterations = 20;
/// Steps below this (rad and m) are invisible in a map; the coarse limit holds while the kernel is
/// still wide.
constexpr double kConverged = 1e-5, kConvergedCoarsely = 1e-3;
/// Added to the diagonal for nodes without constraints, relative to a measurement of 1 rad and 1 m.
constexpr double kLeastInformation = 1e-9;
constexpr double kMaxDamping = 1e6;
/// Squared error that 5 % of the inliers exceed (chi squared, six degrees of freedom).
constexpr double kRobustWidth = 12.6;
constexpr double kNarrowing = 4;
/// A new measurement with a small error that closes no loop moves only this many of the last nodes.
/// Its cost does not grow with the graph.
constexpr std::size_t kRecentNodes = 64;

/// A residual in standard deviations and its derivatives by the twists of its nodes: the pose of a
/// node is T * exp(twist).
struct Term {
  std::optional<std::size_t> from;
  std::size_t to = 0;
  Twist error = Twist::Zero();
  Matrix6 by_from = Matrix6::Zero(), by_to = Matrix6::Zero();
};

/// Inverse of SO(3)'s right Jacobian to second order, which suffices for the small residuals near
/// the solution.
Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& w) {
  const Eigen::Matrix3d W = hat(w);
  return Eigen::Matrix3d::Identity() + 0.5 * W + W * W / 12;
}

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

/// Separate rotation and translation (SO(3) x R^3), both errors in the frame of `to`.
Term term_of(const RelativePose& m, const std::vector<RigidMotion>& poses) {
  const RigidMotion T_from_to = poses[m.from].inverse() * poses[m.to];
  const Eigen::Matrix3d R_measured_to = m.T_from_to.linear().transpose() * T_from_to.linear();
  const Eigen::Vector3d turn = rotation_vector(R_measured_to);
  const Eigen::Matrix3d R_to_from = m.T_from_to.linear().transpose();
  Term term{.from = m.from, .to = m.to};
  term.error.head<3>() = turn;
  term.error.tail<3>() = R_to_from * (T_from_to.translation() - m.T_from_to.translation());
  const Eigen::Matrix3d J = inverse_right_jacobian(turn);
  term.by_to.topLeftCorner<3, 3>() = J;
  term.by_from.topLeftCorner<3, 3>() = -J * T_from_to.linear().transpose();
  // A twist rotates first, then translates, in the node's frame.
  term.by_to.bottomRightCorner<3, 3>() = R_to_from * T_from_to.linear();
  term.by_from.bottomLeftCorner<3, 3>() = R_to_from * hat(T_from_to.translation());
  term.by_from.bottomRightCorner<3, 3>() = -R_to_from;
  const Twist weight = m.sigma.cwiseInverse();
  term.error.array() *= weight.array();
  term.by_from = weight.asDiagonal() * term.by_from;
  term.by_to = weight.asDiagonal() * term.by_to;
  return term;
}

Term term_of(const AbsolutePose& m, const std::vector<RigidMotion>& poses) {
  const RigidMotion& T = poses[m.node];
  const Eigen::Vector3d turn = rotation_vector(m.T_local_node.linear().transpose() * T.linear());
  Term term{.from = {}, .to = m.node};
  term.error.head<3>() = turn;
  term.error.tail<3>() = T.translation() - m.T_local_node.translation();
  term.by_to.topLeftCorner<3, 3>() = inverse_right_jacobian(turn);
  term.by_to.bottomRightCorner<3, 3>() = T.linear();
  const Twist weight = m.sigma.cwiseInverse();
  term.error.array() *= weight.array();
  term.by_to = weight.asDiagonal() * term.by_to;
  return term;
}

Term term_of(const PointPosition& m, const std::vector<RigidMotion>& poses) {
  const RigidMotion& T = poses[m.node];
  Term term{.from = {}, .to = m.node};
  term.error.tail<3>() = (T * m.p_node - m.p_local) / m.sigma;
  term.by_to.bottomLeftCorner<3, 3>() = -T.linear() * hat(m.p_node) / m.sigma;
  term.by_to.bottomRightCorner<3, 3>() = T.linear() / m.sigma;
  return term;
}

/// Cauchy's kernel of a squared width: the cost of a squared error, and the derivative of the cost.
double robust_cost(double squared, double width) { return width * std::log1p(squared / width); }
double robust_weight(double squared, double width) { return 1 / (1 + squared / width); }

RigidMotion moved(const RigidMotion& T, const Twist& twist) {
  RigidMotion step = RigidMotion::Identity();
  const double angle = twist.head<3>().norm();
  if (angle > 0) {
    step.linear() = Eigen::AngleAxisd(angle, twist.head<3>() / angle).toRotationMatrix();
  }
  step.translation() = twist.tail<3>();
  RigidMotion result = T * step;
  result.linear() = nearest_rotation(result.linear());
  return result;
}

}  // namespace

/// Normal equations H step = -b of the nodes from `first` on; H has only its lower blocks.
struct PoseGraph::Equations {
  Equations(std::size_t first_node, std::size_t end)
      : first(first_node), b(Eigen::VectorXd::Zero(Eigen::Index(6 * (end - first_node)))) {}

  void add_block(std::size_t row, std::size_t col, const Matrix6& block) {
    if (col < first) return;  // which is not after the row
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        H.emplace_back(int(6 * (row - first)) + i, int(6 * (col - first)) + j, block(i, j));
      }
    }
  }
  void add_gradient(std::size_t node, const Twist& gradient) {
    if (node >= first) b.segment<6>(Eigen::Index(6 * (node - first))) += gradient;
  }

  std::size_t first;
  std::vector<Eigen::Triplet<double>> H;
  Eigen::VectorXd b;
};

std::size_t PoseGraph::add_node(const RigidMotion& T_local_node) {
  poses_.push_back(T_local_node);
  return poses_.size() - 1;
}

void PoseGraph::move(const RigidMotion& T_new_old) {
  for (RigidMotion& pose : poses_) pose = T_new_old * pose;
}

void PoseGraph::weaken_poses(const Twist& sigma) {
  for (AbsolutePose& measured : absolute_) measured.sigma = sigma;
}

void PoseGraph::add(const RelativePose& measurement) {
  if (measurement.from >= measurement.to || measurement.to >= poses_.size()) {
    throw std::invalid_argument("a relative pose needs two nodes, the earlier first");
  }
  relative_.push_back(measurement);
}

void PoseGraph::add(const AbsolutePose& measurement) {
  if (measurement.node >= poses_.size()) {
    throw std::invalid_argument("an absolute pose needs a node");
  }
  absolute_.push_back(measurement);
}

double PoseGraph::squared_error(const RelativePose& measurement) const {
  return term_of(measurement, poses_).error.squaredNorm();
}

void PoseGraph::add(const PointPosition& measurement) {
  if (measurement.node >= poses_.size()) throw std::invalid_argument("a position needs a node");
  positions_.push_back(measurement);
}

template <class F>
void PoseGraph::for_each_term(const std::vector<RigidMotion>& poses, std::size_t first,
                              F&& f) const {
  for (const RelativePose& m : relative_) {
    if (m.to >= first) f(term_of(m, poses), m.robust);
  }
  for (const AbsolutePose& m : absolute_) {
    if (m.node >= first) f(term_of(m, poses), m.robust);
  }
  for (const PointPosition& m : positions_) {
    if (m.node >= first) f(term_of(m, poses), false);
  }
}

double PoseGraph::cost(const std::vector<RigidMotion>& poses, double width,
                       std::size_t first) const {
  double total = 0;
  for_each_term(poses, first, [&](const Term& term, bool robust) {
    const double squared = term.error.squaredNorm();
    total += robust ? robust_cost(squared, width) : squared;
  });
  return total;
}

PoseGraph::Equations PoseGraph::linearize(double width, std::size_t first) const {
  Equations equations(first, poses_.size());
  for_each_term(poses_, first, [&](const Term& term, bool robust) {
    const double weight = robust ? robust_weight(term.error.squaredNorm(), width) : 1;
    if (term.from) {
      equations.add_block(*term.from, *term.from, weight * term.by_from.transpose() * term.by_from);
      equations.add_block(term.to, *term.from, weight * term.by_to.transpose() * term.by_from);
      equations.add_gradient(*term.from, weight * term.by_from.transpose() * term.error);
    }
    equations.add_block(term.to, term.to, weight * term.by_to.transpose() * term.by_to);
    equations.add_gradient(term.to, weight * term.by_to.transpose() * term.error);
  });
  return equations;
}

double PoseGraph::worst_new_error() const {
  const auto squared_error_of = [&](const auto& measurement) {
    return measurement.robust ? term_of(measurement, poses_).error.squaredNorm() : 0;
  };
  double worst = 0;
  for (std::size_t i = used_relative_; i < relative_.size(); ++i) {
    worst = std::max(worst, squared_error_of(relative_[i]));
  }
  for (std::size_t i = used_absolute_; i < absolute_.size(); ++i) {
    // Navigation with a constant error brings no new information.
    const double before = i > 0 ? squared_error_of(absolute_[i - 1]) : 0;
    const double now = squared_error_of(absolute_[i]);
    if (now > kNarrowing * before) worst = std::max(worst, now);
  }
  return worst;
}

void PoseGraph::optimize() {
  if (poses_.empty()) return;
  // The kernel narrows step by step, since a narrow one ignores an inlier whose error is still
  // large. Measurements of earlier calls have converged.
  double width = worst_new_error();
  const bool closes_loop =
      std::any_of(relative_.begin() + std::ptrdiff_t(used_relative_), relative_.end(),
                  [](const RelativePose& m) { return m.to > m.from + 1; });
  const bool is_first = used_relative_ == 0 && used_absolute_ == 0;
  const bool is_local = width <= kRobustWidth && !closes_loop && !is_first &&
                        positions_.size() == used_positions_ && poses_.size() > kRecentNodes;
  for (; std::isfinite(width) && width > kRobustWidth; width /= kNarrowing) {
    descend(width, kConvergedCoarsely, 0);
  }
  descend(kRobustWidth, kConverged, is_local ? poses_.size() - kRecentNodes : 0);
  used_relative_ = relative_.size();
  used_absolute_ = absolute_.size();
  used_positions_ = positions_.size();
}

void PoseGraph::descend(double width, double converged, std::size_t first) {
  const std::size_t nodes = poses_.size() - first;
  const auto size = Eigen::Index(6 * nodes);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver;
  double best = cost(poses_, width, first), damping = 0;
  for (int iteration = 0; iteration < kMaxIterations && damping < kMaxDamping; ++iteration) {
    Equations equations = linearize(width, first);
    for (int i = 0; i < size; ++i) equations.H.emplace_back(i, i, kLeastInformation + damping);
    Eigen::SparseMatrix<double> H(size, size);
    H.setFromTriplets(equations.H.begin(), equations.H.end());
    if (iteration == 0) solver.analyzePattern(H);
    solver.factorize(H);
    const Eigen::VectorXd step = solver.solve(-equations.b);
    if (solver.info() != Eigen::Success || !step.allFinite()) return;

    std::vector<RigidMotion> poses = poses_;
    for (std::size_t i = 0; i < nodes; ++i) {
      poses[first + i] = moved(poses_[first + i], step.segment<6>(Eigen::Index(6 * i)));
    }
    const double error = cost(poses, width, first);
    if (!(error <= best)) {
      damping = std::max(1.0, damping * 10);
      continue;
    }
    poses_ = std::move(poses);
    best = error;
    damping = damping > 1 ? damping / 10 : 0;
    if (step.lpNorm<Eigen::Infinity>() < converged) return;
  }
}

}  // namespace fovea
