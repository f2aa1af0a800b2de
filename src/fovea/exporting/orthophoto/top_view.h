// What a rectangle of pixels shows from above.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/image.h"

namespace fovea {

/// The highest surface in each pixel. Its color is the mean of its points, which lie at most
/// kThickness below the highest one.
class TopView {
 public:
  static constexpr float kThickness = 0.1f;  ///< m
  /// Gaps of at most this many pixels are filled.
  static constexpr int kWidestGap = 2;

  TopView(int width, int height);

  /// Points come in any order; the same order gives the same picture.
  void add(int column, int row, double z, Rgb color);
  bool has_points(int column, int row) const { return cell(column, row).count > 0; }

  /// A row of red, green, blue and opacity, four bytes a pixel. A pixel without points is filled if
  /// it lies between two with points, in its row, its column or a diagonal, and if the gap has at
  /// most kWidestGap pixels. Its color is the mean of the pixels around the gaps, weighted by the
  /// inverse of their distance. Others are transparent.
  /// @return the number of pixels that were filled
  std::size_t render_row(int row, std::span<std::uint8_t> rgba) const;

 private:
  struct Cell {
    float top = 0;
    std::uint32_t red = 0, green = 0, blue = 0;
    std::uint16_t count = 0;
    bool operator==(const Cell&) const = default;
  };
  const Cell& cell(int column, int row) const {
    return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(column)];
  }
  /// Steps to the next pixel with points; 0 if there is none near.
  int steps_to_points(int column, int row, int step_x, int step_y) const;
  bool fill(int column, int row, std::uint8_t* rgba) const;

  int width_, height_;
  std::vector<Cell> cells_;
};

}  // namespace fovea
