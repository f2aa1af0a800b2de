// Pairs of points and their normal equations, for all registration factors.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fovea/core/lanes.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// Symmetric 3x3 matrix: xx, xy, xz, yy, yz, zz.
using Symmetric3 = Eigen::Matrix<float, 6, 1>;

inline Symmetric3 pack_symmetric(const Eigen::Matrix3f& m) {
  Symmetric3 packed;
  packed << m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2);
  return packed;
}

/// A source point, its nearest target point, and the information matrix M (target axes) of the
/// squared error d^T M d, d = T * source - target. The largest eigenvalue of M is 1 or less: errors
/// are in m^2 with every method. M is constant while the pair exists, so the error of a set of
/// pairs is a function of T alone. A factor computes M. It is a struct with
///   static constexpr bool kNeedsNormals        // of target points
///   static constexpr bool kNeedsSourceNormals  // of source points
///   static constexpr double kMaxPairMove       // of the source point, to reuse a pair (m)
///   static Symmetric3 information(target_normal, source_normal_in_target, options)
struct Pair {
  static constexpr std::uint32_t kNone = 0xffffffff;
  Eigen::Vector3f source;
  Eigen::Vector3f target;
  Symmetric3 information;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // the target's; zero where unknown or unused
  std::uint32_t target_index = kNone;
  /// Position of the source point, in the target's axes, at the last search.
  Eigen::Vector3f searched_at = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Vector3f source_normal = Eigen::Vector3f::Zero();  // zero where unknown or unused
};

/// Eight pairs for one pass of vector instructions.
struct PairBlock {
  std::array<Lanes, 3> source{}, target{}, normal{};
  std::array<Lanes, 6> information{};
  Lanes valid{};  // 1, or 0 where the last block has no pair
};

/// The pairs that have a target.
struct PairBlocks {
  std::vector<PairBlock> blocks;
  std::size_t pairs = 0;

  PairBlocks() = default;
  explicit PairBlocks(std::span<const Pair> all);
};

/// Gauss-Newton normal equations, H * step = -b, of a set of pairs.
///
/// The pose is perturbed on the right, T * exp(step), rotation first. The step is a twist about the
/// source's own origin (the sensor), so the conditioning does not depend on the target's origin.
struct PairEquations {
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Twist b = Twist::Zero();
  /// H of the target's planes alone (M = n n^T), with any method. It serves to detect degenerate
  /// directions: the H of GICP includes the regularization and shrinks with wrong pairs.
  Eigen::Matrix<double, 6, 6> H_planes = Eigen::Matrix<double, 6, 6>::Zero();
  double error = 0;             ///< sum of robust squared errors (m^2)
  double squared_distance = 0;  ///< sum of |T * source - target|^2 (m^2)
  double weight = 0;            ///< sum of robust weights
  std::size_t pairs = 0;
};

/// Equations of pairs at pose T. Sums are in floats within chunks of 1024 pairs and in doubles over
/// the chunks. The result is the same at any number of threads.
PairEquations accumulate(const PairBlocks& pairs, const RigidMotion& T_target_source,
                         double robust_width);

}  // namespace fovea
