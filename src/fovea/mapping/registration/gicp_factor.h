// Generalised ICP (Segal, Haehnel, Thrun 2009): plane to plane.
#pragma once

#include "fovea/mapping/registration/pair_equations.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// Both points are drawn from planes: covariance C = I - (1 - epsilon) n n^T each, variance epsilon
/// along the normal n and 1 in the plane. The error is d^T (C_target + R C_source R^T)^-1 d, here
/// times 2 epsilon, so that the direction of two equal normals counts 1 and a direction in the
/// plane epsilon.
struct GicpFactor {
  static constexpr bool kNeedsNormals = true;
  static constexpr bool kNeedsSourceNormals = true;
  /// Along a wall no pair tells anything, so that it may be of points a little off the nearest.
  static constexpr double kKeepsPairFor = 0.01;  // m

  /// @param n  unit normal of the target point; zero where unknown (then its covariance is I)
  /// @param m  the same of the source point, rotated into the target's axes
  static Symmetric3 information(const Eigen::Vector3f& n, const Eigen::Vector3f& m,
                                const RegistrationOptions& options) {
    // C_target + R C_source R^T = 2 I - k (n n^T + m m^T) has the eigenvectors n + m, n - m and n x
    // m, so its inverse is closed: I/2 + k/4 [(n+m)(n+m)^T / (2 - k(1+c)) + (n-m)(n-m)^T / (2 -
    // k(1-c))].
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
