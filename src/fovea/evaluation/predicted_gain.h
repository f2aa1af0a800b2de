// The exposure of a view, predicted without its image (docs/method.md 7).
#pragma once

#include <optional>
#include <vector>

#include "fovea/map/frame_record.h"

namespace fovea {

/// Factors of red, green and blue: geometric means of the gains of the nearest other frames before
/// and after, of which the map states the camera's gain. At the ends of a drive of the one that
/// there is. Absent if there is none.
/// @param frames  of the map, by index
std::optional<Eigen::Vector3f> predicted_gain(const std::vector<FrameRecord>& frames, int frame,
                                              int camera);

}  // namespace fovea
