// Seams: steps of exposure between points of a map that different images have colored.
#pragma once

#include "fovea/point_cloud.h"

namespace fovea {

struct SeamFigures {
  std::size_t pairs = 0;  ///< pairs of views that share enough places
  /// 95th percentile of the steps of color between the views of a pair, percent: medians over the
  /// places of the pair, so that textures and shadows do not count. NaN without pairs.
  double p95_percent = 0;
};

/// Compares points of different views within 3 cm. A view is a frame and a camera.
/// @param points  colored, with frames and cameras
SeamFigures find_seams(const PointCloud& points);

}  // namespace fovea
