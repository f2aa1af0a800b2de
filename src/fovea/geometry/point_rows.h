// Points in the order of a grid's cells, so that those of neighbouring cells follow each other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/core/lanes.h"
#include "fovea/platform.h"

namespace fovea {

/// Points sorted by the cell they lie in: by z, then y, then x, and in a cell as they came. Cells
/// along x make a row. What lies more than a million cells off counts to the cells there.
class PointRows {
 public:
  /// The cells of y and z, from the first on; there is one more behind the last row and cell, which
  /// begins where they end.
  struct Row {
    std::int32_t y, z;
    std::uint32_t first_cell;
  };
  struct Cell {
    std::int32_t x;
    std::uint32_t first_point;
  };
  struct Range {
    std::uint32_t begin, end;  ///< places of points
  };

  /// @param points  finite
  /// @param edge    of a cell, m
  PointRows(std::span<const Eigen::Vector3f> points, float edge);

  float edge() const { return edge_; }
  std::size_t size() const { return rows_.size() - 1; }  ///< rows
  std::span<const Row> rows() const { return rows_; }
  std::span<const Cell> cells() const { return cells_; }
  /// What point is at each place.
  std::span<const std::uint32_t> order() const { return order_; }
  /// Of those, along each axis, and some more for whole lanes to be read.
  const float* coordinates(std::size_t axis) const { return coordinates_[axis].data(); }

 private:
  template <class Key>
  void sort(std::span<const Eigen::Vector3f> points,
            const std::array<std::vector<std::int32_t>, 3>& cell);

  float edge_;
  std::vector<Row> rows_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> order_;
  std::array<std::vector<float>, 3> coordinates_;
};

/// The points around cells: rows are begun in their order, and of each its cells asked for in the
/// order of x.
class RowSurroundings {
 public:
  /// @param reach      cells to either side, along each axis
  /// @param first_row  none before it will be begun
  RowSurroundings(const PointRows& points, int reach, std::size_t first_row);

  /// Whose cells are asked for next.
  void begin_row(std::size_t row);
  /// Finds the points in the cells around one.
  void move_to(std::int32_t x);

  /// Of them, where they are, none of them empty.
  std::span<const PointRows::Range> ranges() const { return ranges_; }
  std::size_t size() const { return size_; }  ///< points

 private:
  struct Strip {  // of a row nearby: the cells within reach, and where it ends
    std::uint32_t begin, end, row_end;
  };
  const PointRows& points_;
  std::int32_t reach_;
  std::vector<std::size_t> layer_;  // for each z within reach: the first row that may be
  std::vector<Strip> strips_;
  std::vector<PointRows::Range> ranges_;
  std::size_t size_ = 0;
};

}  // namespace fovea
