// The one point-cloud type: a structure of arrays.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "fovea/color.h"

namespace fovea {

/// The rule that let a point into the map: the lower four bits of its reason.
enum class PointRule : std::uint8_t {
  kMeasured = 0,    ///< a return of the LiDAR, where it was measured
  kShortEdges = 1,  ///< sample of a triangle of edges below surface.max_edge
  kPlanar = 2,      ///< sample of a larger one, where the surface goes on straight across its edges
  kCentroid = 3,    ///< centroid of a triangle: the paper's upsampling
};
inline constexpr std::size_t kPointRules = 4;
/// By the rule's number.
inline constexpr std::array<std::string_view, kPointRules> kPointRuleNames = {
    "measured", "short-edges", "planar", "centroid"};

/// Bit of a reason: the point's first color comes from an image whose exposure was off and that
/// was matched to the map's (docs/method.md 6).
inline constexpr std::uint8_t kExposureMatched = 0x10;

constexpr std::uint8_t reason_of(PointRule rule) { return static_cast<std::uint8_t>(rule); }
/// The rule's number in a reason; one that is unknown here comes from a damaged map.
constexpr std::uint8_t rule_number(std::uint8_t reason) { return reason & 0x0f; }

/// Provenance camera number of a point that no camera has colored.
inline constexpr std::int8_t kNoCamera = -1;

/// At sampling level 0, 1, ... a point stands for a cell of 1, 2, 4, 8 or 16 times the spacing.
inline constexpr int kSamplingLevels = 5;

/// N points as columns. `position` is always there; every other column is empty or has N entries.
/// Positions are in meters, in the frame that the variable's name says (`points_lidar`), relative
/// to `origin` (of that same frame): float keeps a tenth of a millimeter within 1 km of it.
struct FOVEA_API PointCloud {
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
  std::vector<std::int8_t> camera;         ///< camera that colored it, or kNoCamera
  std::vector<std::uint8_t> interpolated;  ///< 1 if made by upsampling, 0 if measured
  std::vector<std::uint8_t> views;         ///< images that gave the color; 255: or more
  std::vector<std::uint8_t> spread;        ///< RMS of their differences from it, gray values
  std::vector<std::uint16_t> weight;       ///< sum of the weights of these images
  std::vector<std::uint8_t> saturated;     ///< bits of the channels saturated in all images
  std::vector<std::uint8_t> reason;        ///< a PointRule, and kExposureMatched
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

/// Writes a cloud as binary little endian PLY: x y z (float, m, origin added), and where the cloud
/// has them red green blue (uchar; gray 128 where no camera saw a point), intensity (float) and
/// interpolated (uchar). The file appears when it is whole.
/// @param force  replaces the file
/// @throws OutputError  if the file exists, except with `force`, or cannot be written
FOVEA_API void write_cloud_ply(const PointCloud& cloud, const std::filesystem::path& file,
                               bool force = false);

}  // namespace fovea
