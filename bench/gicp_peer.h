// PCL's registration behind plain numbers; for the reasons see mls_peer.h.
#pragma once

#include <cstddef>

namespace fovea::bench {

enum class PclMethod { kGicp, kIcp };

struct PclRegistration {
  double seconds = 0;  ///< of trees, covariances and alignment
  bool converged = false;
  double T_target_source[16] = {};  ///< row by row
};

/// A cloud of `count` points, three numbers each (m).
struct PclPoints {
  const float* xyz;
  std::size_t count;
};

/// @param guess  T_target_source, row by row
/// @param max_distance  m, pairs further apart are not used
/// @param neighbors     GICP: points that a covariance is of
__attribute__((visibility("default"))) PclRegistration register_by_pcl(
    PclMethod method, PclPoints target, PclPoints source, const double* guess, double max_distance,
    int neighbors);

}  // namespace fovea::bench
