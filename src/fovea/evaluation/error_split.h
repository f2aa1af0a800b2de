// Two parts of the texture error (docs/accuracy.md): the map's nearest point is another place, and
// that place's colour is not the photograph's.
#pragma once

#include <vector>

#include "fovea/evaluation/evaluated_set.h"
#include "fovea/evaluation/metrics.h"

namespace fovea {

/// Sums over evaluated points P whose nearest map point P_n the photograph shows, too. C and C_n
/// are the photograph's colours of P and P_n, M_n is the map's of P_n.
struct ErrorSplit {
  std::size_t points = 0;
  double total = 0;       ///< |C - M_n|: TE
  double sampling = 0;    ///< |C - C_n|: what a perfect colour of P_n would leave
  double same_place = 0;  ///< |C_n - M_n|: what a map point at P itself would leave

  void append(const ErrorSplit& other);
  double mean(double sum) const;  ///< NaN without points
};

/// @param nearest_cam    position of each evaluated point's nearest map point, camera frame
/// @param nearest_color  its colour in the map, 0-255
ErrorSplit split_errors(const EvaluatedView& view, const std::vector<Eigen::Vector3d>& nearest_cam,
                        const std::vector<Eigen::Vector3f>& nearest_color, const Camera& camera,
                        const Image& image);

}  // namespace fovea
