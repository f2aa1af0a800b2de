// Other libraries' registration behind plain numbers; for the reasons see mls_peer.h.
#pragma once

#include <cstddef>

namespace fovea::bench {

/// A cloud of `count` points, three numbers each (m).
struct PeerPoints {
  const float* xyz;
  std::size_t count;
};

/// What to register, and how.
struct RegistrationTask {
  PeerPoints target, source;
  double guess[16] = {};    ///< T_target_source, row by row
  double max_distance = 1;  ///< m, pairs further apart are not used
  int neighbors = 10;       ///< points that a covariance or a normal is of
};

struct PeerRegistration {
  double seconds = 0;               ///< of trees, covariances or normals, and alignment
  double T_target_source[16] = {};  ///< row by row
};

}  // namespace fovea::bench
