// Colours of a map against the true albedo and against what perfect cameras saw.
#pragma once

#include <set>
#include <vector>

#include "fovea/evaluation/truth_poses.h"
#include "fovea/evaluation/truth_surfaces.h"

namespace fovea {

/// Euclidean errors in 8-bit sRGB (0-441; grey cameras: 0-255), as they are and after fitted gains.
struct ColorErrors {
  std::vector<float> raw, gain;
};

/// Of all materials, and of those that mirror nothing.
struct ColorErrorSets {
  ColorErrors all, matte;
};

/// The map's points as the colour metrics want them: coloured, column camera.
struct ColouredTruth {
  const PointCloud& points_true;              ///< the truth's local frame
  const SurfaceMatches& matches;              ///< of the same points
  const std::vector<std::uint8_t>& left_out;  ///< 1 for points that are not compared (ghosts)
};

/// Cameras among `numbers` that the truth knows and whose perfect images have one channel.
std::set<int> grey_cameras(const DriveTruth& truth, const std::vector<int>& numbers, int frame);

/// Against the albedo of the nearest true surface; one gain a channel for the whole map, which
/// takes up its light. Points of grey cameras are left out.
ColorErrorSets albedo_errors(const ColouredTruth& map, const std::set<int>& grey);

/// What the points of one view say of the exposure of the map.
struct ViewExposure {
  int frame = 0, camera = 0;
  std::size_t points = 0;
  double stops = 0;  ///< map over truth, median over points and channels
};

struct ViewErrors {
  ColorErrorSets errors;
  std::vector<float> one_gain;  ///< errors after one gain a channel for the whole map
  std::vector<ViewExposure> exposures;
};

/// Against the perfect image of each point's own frame and camera, bilinear where the true pose of
/// that camera projects the point; one gain a channel and image, which takes up its exposure. Only
/// points that are visible there by the true depth (within 5 cm or 1 %), and whose 5 x 5 pixels
/// have no depth that differs by over 5 %. Column frame needed.
ViewErrors view_errors(const ColouredTruth& map, const DriveTruth& truth,
                       const std::vector<Camera>& cameras);

}  // namespace fovea
