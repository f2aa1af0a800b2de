// Where the pixels of an orthophoto lie.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>

namespace fovea {

/// Pixels in plan, north up. Their borders are whole multiples of the pixel's edge, so that
/// pictures of neighboring tiles fit together.
class PixelGrid {
 public:
  /// Most pixels of a picture, and of its edge: more, and no program opens the picture.
  static constexpr std::int64_t kMostPixels = std::int64_t{1} << 30, kLongestEdge = 1 << 18;

  /// The pixels that contain a box.
  /// @param bounds  m
  /// @param pixel   edge of a pixel, m, above 0
  /// ConfigError that states a larger pixel if there are too many.
  PixelGrid(const Eigen::AlignedBox2d& bounds, double pixel);

  int width() const { return width_; }
  int height() const { return height_; }
  /// From the left, 0 for the first.
  int column(double x) const;
  /// From the top, 0 for the first.
  int row(double y) const;
  /// Six lines: edge, two zeros, negative edge, x and y of the center of the upper left pixel.
  std::string world_file() const;

 private:
  double pixel_;
  double west_, north_;  // numbers of the first column and row, counted east and north from 0
  int width_, height_;
};

}  // namespace fovea
