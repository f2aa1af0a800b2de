#include "fovea/merging/city_gains.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

// Standard deviations, stops: of a gain, of its change from one submap of a map to the next, of a
// tie, of a gain that stays.
constexpr double kGain = 1, kChange = 0.02, kTie = 0.05, kFixed = 1e-6;
constexpr int kRounds = 10;

/// Weighted linear equations for the gains of one channel.
class Equations {
 public:
  explicit Equations(std::size_t size) : right_(Eigen::VectorXd::Zero(Eigen::Index(size))) {}

  /// gain[node] = value
  void add(std::size_t node, double value, double sigma) {
    const double weight = 1 / (sigma * sigma);
    const auto n = int(node);
    left_.emplace_back(n, n, weight);
    right_[n] += weight * value;
  }
  /// gain[b] - gain[a] = value
  void add(std::size_t a, std::size_t b, double value, double sigma) {
    add(b, value, sigma);
    add(a, -value, sigma);
    const double weight = 1 / (sigma * sigma);
    left_.emplace_back(int(std::max(a, b)), int(std::min(a, b)), -weight);
  }
  Eigen::VectorXd solve() const {
    Eigen::SparseMatrix<double> left(right_.size(), right_.size());
    left.setFromTriplets(left_.begin(), left_.end());
    return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>(left).solve(right_);
  }

 private:
  std::vector<Eigen::Triplet<double>> left_;
  Eigen::VectorXd right_;
};

}  // namespace

std::vector<Eigen::Vector3d> city_gains(const std::vector<GainNode>& nodes,
                                        const std::vector<GainTie>& ties) {
  std::vector<Eigen::Vector3d> gains(nodes.size(), Eigen::Vector3d::Zero());
  for (int channel = 0; channel < 3; ++channel) {
    Eigen::VectorXd solution = Eigen::VectorXd::Zero(Eigen::Index(nodes.size()));
    for (int round = 0; round < kRounds; ++round) {
      Equations equations(nodes.size());
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto& fixed = nodes[i].fixed;
        equations.add(i, fixed ? (*fixed)[channel] : 0, fixed ? kFixed : kGain);
        if (nodes[i].continues && i > 0) equations.add(i - 1, i, 0, kChange);
      }
      for (const GainTie& tie : ties) {
        // What b has too much, its gain takes out. Cauchy's kernel, from the second round on.
        const double value = -tie.log2_gain[channel];
        const double error = round == 0 ? 0 : solution[int(tie.b)] - solution[int(tie.a)] - value;
        equations.add(tie.a, tie.b, value, std::hypot(kTie, error));
      }
      solution = equations.solve();
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) gains[i][channel] = solution[int(i)];
  }
  return gains;
}

}  // namespace fovea
