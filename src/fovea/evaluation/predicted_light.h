// The light of a view, predicted without its image (docs/method.md 7).
#pragma once

#include <optional>
#include <vector>

#include "fovea/evaluation/evaluated_set.h"
#include "fovea/map/frame_record.h"

namespace fovea {

/// Mean gain (of logarithms) of the nearest other frames before and after, of which the map states
/// the camera's gain. At the ends of a drive of the one that there is. Absent if there is none.
/// @param frames  of the map, by index
std::optional<ViewLight> predicted_light(const std::vector<FrameRecord>& frames, int frame,
                                         int camera);

/// Colors of the map as a view would show them, 0-255.
/// @param map_colors  at the points of the view
std::vector<Eigen::Vector3f> predicted_colors(const EvaluatedView& view,
                                              const std::vector<Eigen::Vector3f>& map_colors,
                                              const ViewLight& light, const Camera& camera);

}  // namespace fovea
