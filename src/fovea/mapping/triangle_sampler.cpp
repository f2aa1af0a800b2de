#include "fovea/mapping/triangle_sampler.h"

namespace fovea {

void TriangleSampler::add(const std::array<Eigen::Vector3d, 3>& corner, std::uint32_t triangle,
                          Eigen::Index axis, const ColumnStride& stride) {
  switch (axis) {
    case 0:
      return add_along<0>(corner, triangle, stride);
    case 1:
      return add_along<1>(corner, triangle, stride);
    default:
      return add_along<2>(corner, triangle, stride);
  }
}

template <std::uint32_t kAxis>
void TriangleSampler::add_along(const std::array<Eigen::Vector3d, 3>& corner,
                                std::uint32_t triangle, const ColumnStride& stride) {
  constexpr int kU = (kAxis + 1) % 3, kV = (kAxis + 2) % 3;
  const Eigen::Vector3d n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  if (!(n[kAxis] * n[kAxis] > 1e-6 * n.squaredNorm())) return;  // parallel to the axis
  const double slope_u = -n[kU] / n[kAxis], slope_v = -n[kV] / n[kAxis];
  const double cell = grid_.cell;
  // Corners sorted by v, so that two triangles compute the same line for a common edge. Each row
  // crosses the long edge and one of the others.
  const Eigen::Vector3d *low = corner.data(), *middle = &corner[1], *high = &corner[2];
  if ((*middle)[kV] < (*low)[kV]) std::swap(low, middle);
  if ((*high)[kV] < (*middle)[kV]) std::swap(middle, high);
  if ((*middle)[kV] < (*low)[kV]) std::swap(low, middle);
  const double low_u = (*low)[kU], low_v = (*low)[kV], middle_u = (*middle)[kU],
               middle_v = (*middle)[kV];
  const double along_long = ((*high)[kU] - low_u) / ((*high)[kV] - low_v),
               along_lower = (middle_u - low_u) / (middle_v - low_v),
               along_upper = ((*high)[kU] - middle_u) / ((*high)[kV] - middle_v);
  const double at_origin = (*low)[kAxis] - slope_u * low_u - slope_v * low_v;
  const std::int32_t rows = cells_.first_center((*high)[kV]), step = stride.column_step();
  const Lanes<std::int32_t> whole_offsets = step * Lanes<std::int32_t>(0, 1, 2, 3);
  const Lanes<double> offsets = whole_offsets.cast<double>();
  for (std::int32_t row = stride.first_row(cells_.first_center(low_v)); row < rows;
       row += stride.row_step()) {
    const double at_v = (row + 0.5) * cell;
    const double first = low_u + (at_v - low_v) * along_long;
    const double second = at_v < middle_v ? low_u + (at_v - low_v) * along_lower
                                          : middle_u + (at_v - middle_v) * along_upper;
    const std::int32_t columns = cells_.first_center(std::max(first, second));
    const double at_row = at_origin + slope_v * at_v;
    std::int32_t column = stride.first_column(cells_.first_center(std::min(first, second)), row);
    std::int32_t left = stride.columns_between(column, columns);
    for (;; column += kLanes * step, left -= kLanes) {
      const Lanes<double> at_u = ((column + 0.5) + offsets) * cell;
      const Lanes<double> height = at_row + slope_u * at_u;
      put(height, height_);
      put(cells_.numbers_of(height), cell_[kAxis]);
      put(column + whole_offsets, cell_[kU]);
      put(Lanes<std::int32_t>::Constant(row), cell_[kV]);
      put(Lanes<std::uint32_t>::Constant(triangle), triangle_);
      put(Lanes<std::uint32_t>::Constant(kAxis), axis_);
      count_ += static_cast<std::size_t>(std::clamp(left, 0, kLanes));
      if (count_ >= kBlockSize) flush_block();
      if (left <= kLanes) break;
    }
  }
}

void TriangleSampler::flush_block() {
  std::size_t free = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    free_[free] = static_cast<std::uint16_t>(i);
    free += !cells_.is_marked({cell_[0][i], cell_[1][i], cell_[2][i]});
  }
  for (std::size_t k = 0; k < free; ++k) {
    const std::size_t i = free_[k];
    const TriangleSample sample{
        height_[i], {cell_[0][i], cell_[1][i], cell_[2][i]}, triangle_[i], axis_[i]};
    if (!grid_.taken(sample.position(grid_.cell))) samples_.push_back(sample);
  }
  count_ = 0;
}

}  // namespace fovea
