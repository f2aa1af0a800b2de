#include "fovea/rendering/lidar_beams.h"

namespace fovea {

LidarBeams::LidarBeams(const LidarPattern& pattern, double time) : pattern_(pattern) {
  if (!pattern.rosette) return;
  rows_.resize(std::size_t(row_of(0.5 * pattern.rosette->height)) + 1);
  for (int column = 0; column < pattern.columns; ++column) {
    const double since = ((column + 0.5) / pattern.columns - 0.5) * pattern.period;
    const Eigen::Vector2d angles = rosette_angles(*pattern.rosette, time + since);
    const long row = std::clamp(row_of(angles.y()), 0L, long(rows_.size()) - 1);
    rows_[std::size_t(row)].push_back({angles.x(), std::uint32_t(column)});
    angles_.push_back(angles);
  }
  for (std::vector<DrawnBeam>& row : rows_) {
    std::sort(row.begin(), row.end(),
              [](const DrawnBeam& a, const DrawnBeam& b) { return a.azimuth < b.azimuth; });
  }
}

Eigen::Vector3f LidarBeams::direction(std::uint32_t beam) const {
  const auto columns = std::uint32_t(pattern_.columns);
  const double elevation =
      pattern_.rosette ? angles_[beam].y() : pattern_.elevation[beam / columns];
  const double azimuth = pattern_.rosette ? angles_[beam].x() : azimuth_of(int(beam % columns));
  return Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation))
      .cast<float>();
}

}  // namespace fovea
