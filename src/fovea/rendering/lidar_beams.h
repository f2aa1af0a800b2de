// The beams of a LiDAR by their numbers, and which of them point near a direction.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "fovea/rendering/virtual_lidar.h"

namespace fovea {

/// The number of a beam is ring * columns + column.
class LidarBeams {
 public:
  /// Keeps a reference to the pattern.
  /// @param time  s, of the middle of the sweep
  LidarBeams(const LidarPattern& pattern, double time);

  std::size_t size() const { return pattern_.elevation.size() * std::size_t(pattern_.columns); }

  Eigen::Vector3f direction(std::uint32_t beam) const;

  /// Calls f(beam) for the beams within an angle (rad) of the direction of a point. Some of those
  /// that are a little farther off can be among them.
  template <class F>
  void for_each_near(const Eigen::Vector3f& p, float range, double angle, F&& f) const {
    const double elevation = std::asin(std::clamp(double(p.z() / range), -1.0, 1.0));
    const double azimuth = std::atan2(p.y(), p.x());
    if (pattern_.rosette) return for_each_drawn_near(azimuth, elevation, angle, f);
    const auto& rings = pattern_.elevation;
    const auto first =
        std::lower_bound(rings.begin(), rings.end(), elevation + angle, std::greater<double>());
    if (first == rings.end() || *first < elevation - angle) return;
    for (auto ring = first; ring != rings.end() && *ring >= elevation - angle; ++ring) {
      const double spread = angle / std::max(0.05, std::cos(*ring));
      const int begin = int(std::ceil(column_of(azimuth + spread)));
      const int end = int(std::floor(column_of(azimuth - spread)));
      const auto row = std::uint32_t(ring - rings.begin()) * std::uint32_t(pattern_.columns);
      for (int c = begin; c <= std::min(end, begin + pattern_.columns - 1); ++c) {
        f(row + std::uint32_t((c % pattern_.columns + pattern_.columns) % pattern_.columns));
      }
    }
  }

 private:
  /// A beam of a rosette.
  struct DrawnBeam {
    double azimuth;
    std::uint32_t number;
  };
  static constexpr double kTurn = 2 * std::numbers::pi;
  static constexpr double kRowHeight = 0.005;  // rad, of the rows below

  template <class F>
  void for_each_drawn_near(double azimuth, double elevation, double angle, F&& f) const {
    const double spread = angle / std::max(0.05, std::cos(elevation));
    const long last = std::min(row_of(elevation + angle), long(rows_.size()) - 1);
    for (long r = std::max(0L, row_of(elevation - angle)); r <= last; ++r) {
      const std::vector<DrawnBeam>& row = rows_[std::size_t(r)];
      auto beam = std::lower_bound(
          row.begin(), row.end(), azimuth - spread,
          [](const DrawnBeam& drawn, double least) { return drawn.azimuth < least; });
      for (; beam != row.end() && beam->azimuth <= azimuth + spread; ++beam) f(beam->number);
    }
  }

  long row_of(double elevation) const {
    return long(std::floor((elevation + 0.5 * pattern_.rosette->height) / kRowHeight));
  }
  double azimuth_of(int column) const {
    return std::numbers::pi - kTurn * (column + 0.5) / pattern_.columns;
  }
  double column_of(double azimuth) const {
    return (std::numbers::pi - azimuth) / kTurn * pattern_.columns - 0.5;
  }

  const LidarPattern& pattern_;
  std::vector<Eigen::Vector2d> angles_;       // of a rosette's beams: azimuth, elevation
  std::vector<std::vector<DrawnBeam>> rows_;  // of a rosette, by elevation; each by azimuth
};

}  // namespace fovea
