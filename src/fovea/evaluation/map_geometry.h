// The shape of a map: how thin its surfaces are, and how it and the held-out scans cover each
// other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// How far the points of flat pieces of surface lie beside them.
struct PlaneThickness {
  /// Patches are cubes of this edge (m) with at least kMinPoints points. The plane is that of least
  /// squares of the 3 x 3 x 3 cubes around: a plane of the patch alone would turn with the noise.
  static constexpr float kPatch = 0.2f;
  static constexpr std::size_t kMinPoints = 10;
  /// Flat is where the spread across is at most this share of the smaller spread along the plane,
  /// and that at least as large a share of the larger (a line has no plane).
  static constexpr double kFlat = 0.35;

  std::size_t patches = 0;  ///< flat ones
  /// Median over flat patches of the RMS distance of a patch's points to its plane (m). The median,
  /// because kerbs and eaves are in some patches whatever the map. NaN without patches.
  double thickness = std::numeric_limits<double>::quiet_NaN();
};
PlaneThickness plane_thickness(const std::vector<Eigen::Vector3f>& map);

/// Precision, recall and F-score of a map against scans that it does not know (Knapitsch, Park,
/// Zhou, Koltun 2017, "Tanks and Temples", ACM TOG 36). Precision is the share of map points, one a
/// 5-cm voxel, with a scan's point this near: scans have gaps between their rings, which cost
/// precision. Recall is the share of scan points with a map point this near.
struct ScanScores {
  static constexpr std::array<int, 3> kCentimetres = {5, 10, 20};
  std::array<double, 3> precision{}, recall{}, f_score{};  ///< NaN where there is nothing
  std::size_t map_samples = 0;
};
/// @param map         the points that the scans could have seen
/// @param scan        same frame and origin
/// @param distances   of the scan's points to the map
ScanScores scan_scores(const std::vector<Eigen::Vector3f>& map,
                       const std::vector<Eigen::Vector3f>& scan,
                       const std::vector<float>& distances);

}  // namespace fovea
