#include "fovea/map/keyframe_returns.h"

#include <cmath>

namespace fovea {

std::vector<Eigen::Vector3f> returns_of(const KeyframeRecord& keyframe, double max_range) {
  std::vector<Eigen::Vector2f> azimuths;  // cosine and sine
  for (std::size_t column = 0; column < keyframe.columns; ++column) {
    const double azimuth = keyframe.first_azimuth + double(column) * keyframe.azimuth_step;
    azimuths.emplace_back(std::cos(azimuth), std::sin(azimuth));
  }
  std::vector<Eigen::Vector3f> points;
  for (std::size_t row = 0; row < keyframe.elevations.size(); ++row) {
    const auto up = float(std::sin(keyframe.elevations[row])),
               along = float(std::cos(keyframe.elevations[row]));
    for (std::size_t column = 0; column < keyframe.columns; ++column) {
      const float range = 0.01f * float(keyframe.ranges[row * keyframe.columns + column]);
      if (range == 0 || range > float(max_range)) continue;
      points.emplace_back(range * along * azimuths[column].x(),
                          range * along * azimuths[column].y(), range * up);
    }
  }
  return points;
}

}  // namespace fovea
