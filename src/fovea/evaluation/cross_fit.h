// A map's colors in the exposure of a held-out view, without fitting to the points that are scored
// (docs/method.md 7).
#pragma once

#include <vector>

#include "fovea/evaluation/evaluated_set.h"

namespace fovea {

/// Edge of a block of the held-out image, pixels.
inline constexpr int kCrossFitBlock = 64;

/// The blocks of the image form two sets, as on a chessboard. One gain per channel is fitted to
/// each set by least squares and applied to the points of the other set.
/// @param map  colors of the nearest map points, 0-255; one a point of the view
/// @return     clipped to 255, as the image is. A channel of which a set has no unsaturated value
///             keeps the map's values in the other set.
std::vector<Eigen::Vector3f> cross_fitted(const EvaluatedView& view,
                                          const std::vector<Eigen::Vector3f>& map);

/// Distance of two colors that does not grow with brightness: RMS over channels of the difference
/// of natural logarithms. Values below 8 count as 8: there noise dominates.
float log_color_error(const Eigen::Vector3f& truth, const Eigen::Vector3f& map, bool gray);

}  // namespace fovea
