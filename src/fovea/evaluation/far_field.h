// What a map shows beyond the evaluated set: from 15 m, where that ends, to 60 m (docs/method.md
// 7).
#pragma once

#include <array>

#include "fovea/evaluation/evaluated_set.h"
#include "fovea/evaluation/metrics.h"
#include "fovea/rendering/splat.h"

namespace fovea {

inline constexpr std::array<RangeBand, 3> kFarBands{{{15, 25}, {25, 40}, {40, 60}}};

/// Sums over the returns of one band on one kind of surface.
struct FarSums {
  std::size_t points = 0;
  /// With a map point within 5 or 10 cm, or within the footprint of a pixel if that is larger.
  std::size_t covered_5cm = 0, covered_10cm = 0;
  double color = 0;              ///< TE, cross-fitted
  std::size_t flat = 0;          ///< covered points on flat surfaces
  std::size_t double_layer = 0;  ///< of these: the map has a second surface within 50 cm

  FarSums& operator+=(const FarSums& other);
};

/// By band: returns of the ground, and of everything that stands on it.
struct FarBand {
  FarSums ground, upright;
};

struct FarField {
  std::array<FarBand, kFarBands.size()> bands;
  std::size_t measured = 0, holes = 0;  ///< pixels on surfaces of the scan; without a map point
  double squared = 0;                   ///< over the measured pixels; a hole is black

  FarField& operator+=(const FarField& other);
  FarSums all() const;
  double share_of_holes() const;  ///< NaN without pixels
  /// PSNR over the measured pixels, dB.
  double psnr() const;
};

/// A map, ready to be compared.
struct FarMap {
  const std::vector<Eigen::Vector3f>& position;
  const std::vector<LogColor>& color;
  const KdTree& tree;  ///< of `position`
  Eigen::Vector3d origin_local;
};

/// A photograph, and the map drawn in its view and exposure.
struct FarPictures {
  const Image& photograph;
  SplatView drawn;
  const ImageMask* mask = nullptr;  ///< absent: every pixel shows the scene
};

/// Compares one scan and one photograph with a map: visible returns in the bands, and every pixel
/// between the returns of a surface up to 60 m.
/// @param measured_lidar     scan as measured: its ranges decide
/// @param compensated_lidar  the same, motion compensated
FarField compare_far_field(const FarMap& map, const PointCloud& measured_lidar,
                           const PointCloud& compensated_lidar, const PlacedFrame& placed,
                           const Camera& camera, const FarPictures& pictures);

}  // namespace fovea
