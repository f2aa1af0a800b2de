// Generalized ICP (Segal, Haehnel, Thrun 2009): plane to plane.
#pragma once

#include "fovea/mapping/registration/pair_equations.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// Each point has the covariance C = I - (1 - epsilon) n n^T: variance epsilon along its normal n
/// and 1 in the plane. The error is d^T (C_target + R C_source R^T)^-1 d. It is scaled by
/// 2 epsilon: with equal normals, M has the eigenvalue 1 along the normal and epsilon in the plane.
struct GicpFactor {
  static constexpr bool kNeedsNormals = true;
  static constexpr bool kNeedsSourceNormals = true;
  /// Another target point on the same plane gives nearly the same equations.
  static constexpr double kMaxPairMove = 0.01;  // m, see PairCache

  /// @param n  unit normal of the target point; zero where unknown (its covariance is then I)
  /// @param m  the same of the source point, rotated into the target's axes
  static Symmetric3 information(const Eigen::Vector3f& n, const Eigen::Vector3f& m,
                                const RegistrationOptions& options) {
    // C_target + R C_source R^T = 2 I - k (n n^T + m m^T) has the eigenvectors n + m, n - m and
    // n x m. Its inverse is therefore
    // I/2 + k/4 [(n+m)(n+m)^T / (2 - k(1+c)) + (n-m)(n-m)^T / (2 - k(1-c))].
    const float epsilon = static_cast<float>(options.plane_epsilon);
    const float k = 1 - epsilon;
    const float c = n.dot(m);
    const Eigen::Vector3f sum = n + m;
    const Eigen::Vector3f difference = n - m;
    const float along_sum = 0.5f * epsilon * k / (2 - k * (1 + c));
    const float along_difference = 0.5f * epsilon * k / (2 - k * (1 - c));
    const Eigen::Matrix3f M = epsilon * Eigen::Matrix3f::Identity() +
                              along_sum * sum * sum.transpose() +
                              along_difference * difference * difference.transpose();
    return pack_symmetric(M);
  }
};

}  // namespace fovea
