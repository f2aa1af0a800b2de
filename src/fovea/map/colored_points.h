// The coloured points of a map, as all metrics see them: every one of them looks at these only.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fovea/point_cloud.h"

namespace fovea {

/// Bounding box of consecutive points. A map comes tile by tile, so that a run of its points is
/// compact, and what is far from a scan is passed over a run at a time.
struct PointRun {
  std::uint32_t begin = 0, end = 0;
  Eigen::Vector3f low, high;

  /// Distance from a point to the box, 0 inside (m).
  float distance_to(const Eigen::Vector3f& p) const {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0f).norm();
  }
};

struct ColoredPoints {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> position;  ///< local frame, relative to origin
  std::vector<LogColor> color;
  std::vector<std::uint8_t> interpolated;    ///< 1 if made by upsampling; empty where not known
  std::vector<std::uint8_t> reason;          ///< core/point_reason.h; empty where not known
  std::vector<std::int32_t> frame;           ///< that the point comes from; empty where not known
  std::vector<std::uint8_t> sampling_level;  ///< empty where not known
  std::vector<PointRun> runs;                ///< covering all points in order
};

/// The points of a map (local frame, columns color and camera) that some camera has coloured.
/// @param map_local  move it here if it is not used again: a second copy of a city is large
ColoredPoints colored_points(PointCloud map_local);

/// All points of a map, colored or not.
ColoredPoints all_points(PointCloud map_local);

/// Runs of at most `length` points.
std::vector<PointRun> make_runs(const std::vector<Eigen::Vector3f>& position, std::size_t length);

/// Distance between neighbouring samples of the surface around each point (m): the edge of the
/// square that is each point's share of it, from the points in the 30-cm cube around its 10-cm
/// voxel; at most 0.1 m.
std::vector<float> sample_spacing(const std::vector<Eigen::Vector3f>& position);

/// The same by the cells that the points stand for: at most 1.5 of their edges, which closes a
/// surface, and half an edge for an isolated point, which is none.
/// @param cell  edge of a finest cell, m
std::vector<float> sample_spacing(const ColoredPoints& map, double cell);

/// Map points per m^2 of surface: the mean, over one evaluated point a 10-cm voxel (so that every
/// patch of surface counts alike), of the map points within 10 cm of it over the disc pi (0.1 m)^2.
/// Exact on a plane however it lies; 0 where the map has a hole.
/// @param evaluated  same frame and origin as `map`; NaN if empty
double surface_density(const std::vector<Eigen::Vector3f>& map,
                       const std::vector<Eigen::Vector3f>& evaluated);

}  // namespace fovea
