// What every registration factor shares: a pair of points, its error and its normal equations.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fovea/base/lanes.h"
#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Symmetric 3x3 matrix: xx, xy, xz, yy, yz, zz.
using Symmetric3 = Eigen::Matrix<float, 6, 1>;

inline Symmetric3 pack_symmetric(const Eigen::Matrix3f& m) {
  Symmetric3 packed;
  packed << m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2);
  return packed;
}

/// A source point, its nearest target point, and what a factor says of them. A factor is a struct
/// with
///   static constexpr bool kNeedsNormals        // of target points
///   static constexpr bool kNeedsSourceNormals  // of source points, too
///   static constexpr double kKeepsPairFor  // while its source point moves less (m)
///   static Symmetric3 information(target_normal, source_normal_in_target, options)
/// the matrix M (target axes) of the pair's squared error d^T M d, d = T * source - target. M is
/// scaled so that a fully trusted direction counts 1: the error is in m^2 with every method. M
/// stays as it is while the pair does, which makes the error of a set of pairs a plain function of
/// T.
struct Pair {
  static constexpr std::uint32_t kNone = 0xffffffff;
  Eigen::Vector3f source;
  Eigen::Vector3f target;
  Symmetric3 information;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // the target's; zero where unknown or unused
  std::uint32_t target_index = kNone;
  /// Where the source point was, in the target's axes, when its nearest was looked for.
  Eigen::Vector3f looked_at = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
};

/// Pairs whose terms are computed side by side.
struct PairBlock {
  std::array<Lanes, 3> source{}, target{}, normal{};
  std::array<Lanes, 6> information{};
  Lanes counts{};  // 1; 0 where the last block has no pair
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
/// The pose is perturbed on the right, T * exp(step), rotation first: the step is a twist about the
/// source's own origin (the sensor), so that rotation and translation are conditioned alike
/// wherever the target's origin lies.
struct PairEquations {
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Twist b = Twist::Zero();
  /// H of the target's planes alone (M = n n^T): what the scene's shape can tell, whatever the
  /// method. Degeneracy is judged by it; GICP's H holds its regularisation too, and shrinks where
  /// pairs are wrong, as they all are at a poor first guess.
  Eigen::Matrix<double, 6, 6> H_planes = Eigen::Matrix<double, 6, 6>::Zero();
  double error = 0;             ///< sum of robust squared errors (m^2)
  double squared_distance = 0;  ///< sum of |T * source - target|^2 (m^2)
  double weight = 0;            ///< sum of robust weights
  std::size_t pairs = 0;
};

/// Equations of pairs at pose T. Sums are of floats within a thousand pairs, of doubles beyond, in
/// fixed chunks: the same at any number of threads.
PairEquations accumulate(const PairBlocks& pairs, const RigidMotion& T_target_source,
                         double robust_width);

}  // namespace fovea
