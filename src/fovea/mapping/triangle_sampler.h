// Samples of triangles at the cells of a grid (surface_samples.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "fovea/mapping/surface_samples.h"

namespace fovea {

/// The cells of a SampleGrid.
class GridCells {
 public:
  explicit GridCells(const SampleGrid& grid)
      : grid_(grid),
        cells_per_meter_(1 / grid.cell),
        steps_per_meter_(1 / (grid.step > 0 ? grid.step : grid.cell)),
        cells_per_step_(grid.step > 0 ? grid.step / grid.cell : 1),
        half_(grid.step > 0 ? 0.5 : 0),
        offset_(grid.step > 0 ? kStepsOn : 0) {}

  /// Cell numbers of coordinates (m) along one axis, after the coordinates are rounded to steps.
  template <int kCount>
  Eigen::Array<std::int32_t, kCount, 1> numbers_of(
      const Eigen::Array<double, kCount, 1>& coordinates) const {
    const Eigen::Array<double, kCount, 1> number =
        (((coordinates * steps_per_meter_ + half_).floor() + offset_) * cells_per_step_).floor();
    return number.template cast<std::int32_t>();  // a statement of its own, so that both vectorize
  }

  /// Number of the first cell whose center is not below `coordinate` (m).
  std::int32_t first_center(double coordinate) const {
    return static_cast<std::int32_t>(std::ceil(coordinate * cells_per_meter_ - 0.5));
  }

  /// Whether a brick of the grid marks the cell. Fast if the cell is near the previous one.
  bool is_marked(const Eigen::Array3i& cell) {
    const Eigen::Array3i number = CellBrick::number_of(cell);
    if (!CellBrick::same(number, brick_number_)) {
      brick_number_ = number;
      brick_ = grid_.taken_brick(number);
      if (brick_ == nullptr) brick_ = &kEmpty;
    }
    return brick_->test(cell);
  }

  /// Whether the cell has a point.
  /// @param p_grid  in the cell
  bool is_taken(const Eigen::Array3i& cell, const Eigen::Vector3d& p_grid) {
    return is_marked(cell) || grid_.taken(p_grid);
  }

 private:
  static constexpr CellBrick kEmpty{};
  const SampleGrid& grid_;
  double cells_per_meter_, steps_per_meter_, cells_per_step_, half_, offset_;
  Eigen::Array3i brick_number_ = CellBrick::no_number();  // of the last call
  const CellBrick* brick_ = &kEmpty;
};

/// The columns of cells that are sampled: all; after one halving every second, as on a chessboard;
/// then every fourth, eighth... Each finer stride contains the coarser ones.
class ColumnStride {
 public:
  explicit ColumnStride(int halvings)
      : column_shift_((halvings + 1) / 2),
        row_step_(1 << halvings / 2),
        column_step_(1 << column_shift_) {}
  std::int32_t row_step() const { return row_step_; }
  std::int32_t column_step() const { return column_step_; }
  /// The first sampled row from `row` on.
  std::int32_t first_row(std::int32_t row) const { return next(row, row_step_, 0); }
  std::int32_t first_column(std::int32_t column, std::int32_t row) const {
    const bool shifted = column_step_ > row_step_ && (row & row_step_) != 0;
    return next(column, column_step_, shifted ? row_step_ : 0);
  }
  /// Number of sampled columns from `column`, which is one, up to `end`; at most 0 if `end` is not
  /// beyond it.
  std::int32_t columns_between(std::int32_t column, std::int32_t end) const {
    return (end - column + column_step_ - 1) >> column_shift_;
  }

 private:
  /// The first number from `at` on that is a multiple of `step`, a power of two, plus `shift`.
  static std::int32_t next(std::int32_t at, std::int32_t step, std::int32_t shift) {
    return ((at - shift + step - 1) & -step) + shift;
  }
  int column_shift_;
  std::int32_t row_step_, column_step_;
};

/// The point where a column of cells meets a triangle.
struct TriangleSample {
  double height;        ///< m along the column's axis
  Eigen::Array3i cell;  ///< its center along the other two axes
  std::uint32_t triangle, axis;

  /// @param edge  of a cell, m
  Eigen::Vector3d position(double edge) const {
    Eigen::Vector3d p = (cell.cast<double>() + 0.5) * edge;
    p[axis] = height;
    return p;
  }
};

/// Collects samples of triangles whose cells have no point yet. Samples are tested in blocks of a
/// few hundred, over many triangles, and compacted without branches: which cells are free is
/// unpredictable.
class TriangleSampler {
 public:
  explicit TriangleSampler(const SampleGrid& grid) : grid_(grid), cells_(grid) {
    samples_.reserve(kUsualSamples);
  }

  /// Samples a triangle along the columns of one axis.
  void add(const std::array<Eigen::Vector3d, 3>& corner, std::uint32_t triangle, Eigen::Index axis,
           const ColumnStride& stride);

  std::vector<TriangleSample> take() && {
    flush_block();
    return std::move(samples_);
  }

 private:
  static constexpr std::size_t kUsualSamples = 4096;
  static constexpr std::size_t kBlockSize = 256;
  static constexpr int kLanes = 4;  // samples computed at once
  template <class T>
  using Row = std::array<T, kBlockSize + kLanes>;
  template <class T>
  using Lanes = Eigen::Array<T, kLanes, 1>;

  template <std::uint32_t kAxis>
  void add_along(const std::array<Eigen::Vector3d, 3>& corner, std::uint32_t triangle,
                 const ColumnStride& stride);
  /// Writes values at the end of a row of the block.
  template <class T, class Values>
  void put(const Values& values, Row<T>& row) {
    Eigen::Map<Lanes<T>> end(&row[count_]);
    end = values;
  }
  /// Moves the block's free samples to `samples_`.
  void flush_block();

  const SampleGrid& grid_;
  GridCells cells_;
  Row<double> height_;
  std::array<Row<std::int32_t>, 3> cell_;
  Row<std::uint32_t> triangle_, axis_;
  std::size_t count_ = 0;  // in the block
  Row<std::uint16_t> free_;
  std::vector<TriangleSample> samples_;
};

}  // namespace fovea
