#include "fovea/mapping/calibration/image_edge_map.h"

#include <algorithm>
#include <cmath>

#include "fovea/mapping/calibration/gray_plane.h"

namespace fovea {
namespace {

constexpr double kMapFocal = 360;       // pixels: larger images are reduced to about this
constexpr float kNoise = 4;             // gray values: weaker steps are no edges
constexpr float kContrast = 2;          // gray values, added to the strength of a neighborhood
constexpr double kNeighborhood = 0.12;  // rad, half its side
constexpr float kFloor = 0.1f;          // of the neighborhood's strength: no edge at all

/// Steps of the image across upright (dx = 1, dy = 0) or level edges.
GrayPlane steps(const GrayPlane& gray, int dx, int dy) {
  GrayPlane result{gray.width, gray.height, {}};
  for (int y = 0; y < gray.height; ++y) {
    for (int x = 0; x < gray.width; ++x) {
      const int right = std::min(x + dx, gray.width - 1), left = std::max(x - dx, 0);
      const int down = std::min(y + dy, gray.height - 1), up = std::max(y - dy, 0);
      result.values.push_back(
          std::max(0.0f, std::abs(gray.at(right, down) - gray.at(left, up)) - kNoise));
    }
  }
  return result;
}

std::vector<float> log_strength(const GrayPlane& strength, const GrayPlane& neighborhood,
                                double sigma) {
  GrayPlane result = smoothed(strength, sigma);
  double sum = 0;
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    float& value = result.values[i];
    value = std::log(kFloor + value / (neighborhood.values[i] + kContrast));
    sum += double(value);
  }
  const auto mean =
      static_cast<float>(sum / double(std::max<std::size_t>(1, result.values.size())));
  for (float& value : result.values) value -= mean;
  return std::move(result.values);
}

}  // namespace

ImageEdgeMap::ImageEdgeMap(const Image& image, double focal) {
  const int factor = std::max(1, static_cast<int>(std::lround(focal / kMapFocal)));
  const GrayPlane gray = gray_plane(image, factor);
  width_ = gray.width;
  height_ = gray.height;
  scale_ = 1 / float(factor);
  const double map_focal = focal / factor;
  for (const int orientation : {0, 1}) {
    const GrayPlane strength = steps(gray, 1 - orientation, orientation);
    const GrayPlane neighborhood =
        box_blurred(strength, static_cast<int>(std::lround(kNeighborhood * map_focal)));
    for (int level = 0; level < kLevels; ++level) {
      levels_[std::size_t(level)][std::size_t(orientation)] =
          log_strength(strength, neighborhood, kWidths[std::size_t(level)] * map_focal);
    }
  }
}

}  // namespace fovea
