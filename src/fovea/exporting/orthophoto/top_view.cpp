#include "fovea/exporting/orthophoto/top_view.h"

#include <algorithm>
#include <array>
#include <limits>

namespace fovea {

TopView::TopView(int width, int height)
    : width_(width),
      height_(height),
      cells_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

void TopView::add(int column, int row, double z, Rgb color) {
  Cell& cell = cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                      static_cast<std::size_t>(column)];
  const auto height = static_cast<float>(z);
  if (cell.count > 0 && height < cell.top - kThickness) return;
  if (cell.count > 0 && height > cell.top + kThickness) cell = {};
  cell.top = cell.count > 0 ? std::max(cell.top, height) : height;
  if (cell.count == std::numeric_limits<std::uint16_t>::max()) return;
  cell.red += color.r;
  cell.green += color.g;
  cell.blue += color.b;
  ++cell.count;
}

int TopView::steps_to_points(int column, int row, int step_x, int step_y) const {
  for (int steps = 1; steps <= kWidestGap; ++steps) {
    column += step_x;
    row += step_y;
    if (column < 0 || column >= width_ || row < 0 || row >= height_) return 0;
    if (has_points(column, row)) return steps;
  }
  return 0;
}

bool TopView::fill(int column, int row, std::uint8_t* rgba) const {
  struct Direction {
    int x, y;
  };
  constexpr std::array<Direction, 4> kDirections{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weights = 0;
  const auto add = [&](const Cell& cell, int steps) {
    const float weight = 1 / static_cast<float>(steps);
    const Eigen::Vector3f color(float(cell.red), float(cell.green), float(cell.blue));
    sum += weight / float(cell.count) * color;
    weights += weight;
  };
  for (const auto& [x, y] : kDirections) {
    const int ahead = steps_to_points(column, row, x, y);
    const int behind = steps_to_points(column, row, -x, -y);
    if (ahead == 0 || behind == 0 || ahead + behind - 1 > kWidestGap) continue;
    add(cell(column + ahead * x, row + ahead * y), ahead);
    add(cell(column - behind * x, row - behind * y), behind);
  }
  if (weights == 0) return false;
  const Rgb color = to_rgb(sum / weights);
  rgba[0] = color.r, rgba[1] = color.g, rgba[2] = color.b, rgba[3] = 255;
  return true;
}

std::size_t TopView::render_row(int row, std::span<std::uint8_t> rgba) const {
  std::size_t filled = 0;
  std::fill(rgba.begin(), rgba.end(), std::uint8_t{0});
  for (int column = 0; column < width_; ++column) {
    std::uint8_t* pixel = &rgba[4 * static_cast<std::size_t>(column)];
    const Cell& here = cell(column, row);
    if (here.count == 0) {
      filled += fill(column, row, pixel);
      continue;
    }
    const auto mean = [&](std::uint32_t channel_sum) {
      return static_cast<std::uint8_t>((channel_sum + here.count / 2u) / here.count);
    };
    pixel[0] = mean(here.red), pixel[1] = mean(here.green), pixel[2] = mean(here.blue);
    pixel[3] = 255;
  }
  return filled;
}

}  // namespace fovea
