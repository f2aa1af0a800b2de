// Registers submaps of one map to submaps of another one.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/color.h"
#include "fovea/merging/submap_scans.h"

namespace fovea {

/// Where a submap of B lies relative to a submap of A.
struct SubmapMatch {
  std::size_t submap_a = 0, submap_b = 0;
  RigidMotion T_a_b = RigidMotion::Identity();  ///< of the submaps
  /// Of a twist of B's submap in its own frame: rad, m.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  double overlap = 0;   ///< share of B's vertical surfaces with a counterpart in A
  double on_plane = 0;  ///< share of these on the plane of their counterpart
  /// Colors of B = colors of A * 2^gain; absent if they have too few colored points in common.
  std::optional<LogGain> log2_gain = {};
};

/// Largest number of partners of a submap in another map.
inline constexpr std::size_t kMostPartners = 8;

struct SubmapMatches {
  std::vector<SubmapMatch> matches;  ///< without gains; by the submaps of B
  std::size_t tried = 0;             ///< pairs of submaps with common space
};

/// Registers each submap of B to up to kMostPartners submaps of A around it, spread over the space
/// around. What one submap finds is the next one's guess.
/// @param guess_T_a_b  of the local frames, good to some 5 m where the maps first meet
SubmapMatches match_submaps(SubmapScans& a, const MapContent& content_a, SubmapScans& b,
                            const MapContent& content_b, const RigidMotion& guess_T_a_b);

}  // namespace fovea
