// The one point-cloud type: a structure of arrays.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/core/log_color.h"
#include "fovea/core/point_reason.h"

namespace fovea {

/// Provenance camera number of a point that no camera has coloured.
inline constexpr std::int8_t kNoCamera = -1;

/// At sampling level 0, 1, ... a point stands for a cell of 1, 2, 4, 8 or 16 times the spacing.
inline constexpr int kSamplingLevels = 5;

/// N points as columns. `position` is always there; every other column is empty or has N entries.
/// Positions are in metres, in the frame that the variable's name says (`points_lidar`), relative
/// to `origin` (of that same frame): float keeps a tenth of a millimetre within 1 km of it.
struct PointCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> position;

  std::vector<float> intensity;            ///< LiDAR reflectance, 0-1
  std::vector<std::uint16_t> ring;         ///< of the LiDAR, as the scan's file numbers it
  std::vector<std::uint16_t> sensor;       ///< number of the LiDAR that measured it; empty: 0
  std::vector<float> time;                 ///< s from the scan's stamp; none once compensated
  std::vector<Eigen::Vector3f> normal;     ///< unit, towards the sensor; zero where unknown
  std::vector<float> range;                ///< m, from the sensor that measured or saw the point
  std::vector<float> incidence;            ///< rad, between view ray and normal; NaN if unknown
  std::vector<LogColor> color;             ///< meaningful where camera != kNoCamera
  std::vector<std::int32_t> frame;         ///< frame index the point comes from
  std::vector<std::int8_t> camera;         ///< camera that coloured it, or kNoCamera
  std::vector<std::uint8_t> interpolated;  ///< 1 if made by upsampling, 0 if measured
  std::vector<std::uint8_t> views;         ///< images that gave the colour; 255: or more
  std::vector<std::uint8_t> spread;        ///< RMS of their differences from it, grey values
  std::vector<std::uint16_t> weight;       ///< sum of their weights (mapping/color_fusion.h)
  std::vector<std::uint8_t> saturated;     ///< channels saturated in every view (fused_color.h)
  std::vector<std::uint8_t> reason;        ///< why it is there (core/point_reason.h)
  std::vector<std::uint8_t> sampling_level;

  std::size_t size() const { return position.size(); }
  std::uint16_t sensor_at(std::size_t i) const { return sensor.empty() ? 0 : sensor[i]; }
  bool empty() const { return position.empty(); }

  /// Throws std::logic_error that names the first optional column of neither 0 nor size() entries.
  void check() const;

  /// The points at `indices`, in that order, with every column that this cloud has.
  PointCloud select(const std::vector<std::uint32_t>& indices) const;

  /// Keeps only the points at `indices` (ascending), in place.
  void keep(const std::vector<std::uint32_t>& indices);

  /// Drops the points that are marked, in place, and returns how many.
  std::size_t drop(const std::vector<std::uint8_t>& marks);

  /// Appends `other`, which must have the same origin and columns (or this cloud is empty). Only
  /// the column `sensor` may be missing.
  void append(const PointCloud& other);
};

/// Calls `f(name, column)` for each optional column of a (const) cloud.
template <class Cloud, class F>
void for_each_optional_column(Cloud& cloud, F&& f) {
  f("intensity", cloud.intensity);
  f("ring", cloud.ring);
  f("sensor", cloud.sensor);
  f("time", cloud.time);
  f("normal", cloud.normal);
  f("range", cloud.range);
  f("incidence", cloud.incidence);
  f("color", cloud.color);
  f("frame", cloud.frame);
  f("camera", cloud.camera);
  f("interpolated", cloud.interpolated);
  f("views", cloud.views);
  f("spread", cloud.spread);
  f("weight", cloud.weight);
  f("saturated", cloud.saturated);
  f("reason", cloud.reason);
  f("sampling_level", cloud.sampling_level);
}

/// Calls `f(name, column_a, column_b)` for each optional column of two clouds.
template <class CloudA, class CloudB, class F>
void for_each_optional_column(CloudA& a, CloudB& b, F&& f) {
  f("intensity", a.intensity, b.intensity);
  f("ring", a.ring, b.ring);
  f("sensor", a.sensor, b.sensor);
  f("time", a.time, b.time);
  f("normal", a.normal, b.normal);
  f("range", a.range, b.range);
  f("incidence", a.incidence, b.incidence);
  f("color", a.color, b.color);
  f("frame", a.frame, b.frame);
  f("camera", a.camera, b.camera);
  f("interpolated", a.interpolated, b.interpolated);
  f("views", a.views, b.views);
  f("spread", a.spread, b.spread);
  f("weight", a.weight, b.weight);
  f("saturated", a.saturated, b.saturated);
  f("reason", a.reason, b.reason);
  f("sampling_level", a.sampling_level, b.sampling_level);
}

}  // namespace fovea
