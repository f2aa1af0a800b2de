#include "fovea/mapping/surface_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/base/parallel.h"
#include "fovea/geometry/cell_brick.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 512;  // triangles
constexpr std::size_t kSampleGrain = 4096;

/// The number, along one axis, of the cell in which a coordinate (m) will be once it is rounded.
class CellNumber {
 public:
  explicit CellNumber(const SampleGrid& grid)
      : steps_per_metre_(1 / (grid.step > 0 ? grid.step : grid.cell)),
        cells_per_step_(grid.step > 0 ? grid.step / grid.cell : 1),
        half_(grid.step > 0 ? 0.5 : 0),
        beyond_(grid.step > 0 ? kStepsOn : 0) {}
  /// Of several at once; by products, since this is asked for every sample and quotients take
  /// longer.
  template <int kCount>
  Eigen::Array<std::int32_t, kCount, 1> operator()(
      const Eigen::Array<double, kCount, 1>& coordinates) const {
    const Eigen::Array<double, kCount, 1> number =
        (((coordinates * steps_per_metre_ + half_).floor() + beyond_) * cells_per_step_).floor();
    return number.template cast<std::int32_t>();  // apart: with it all would be done one by one
  }

 private:
  double steps_per_metre_, cells_per_step_, half_, beyond_;
};

/// What is the same for all triangles.
struct Cells {
  double edge, per_metre;
  CellNumber number;
  explicit Cells(const SampleGrid& grid)
      : edge(grid.cell), per_metre(1 / grid.cell), number(grid) {}
  /// Number of the first cell whose centre is not before `coordinate` (m).
  std::int32_t first_center(double coordinate) const {
    return static_cast<std::int32_t>(std::ceil(coordinate * per_metre - 0.5));
  }
};

/// Where a column of the grid's cells along `axis` meets a triangle.
struct Sample {
  double height;        // m along the axis
  Eigen::Array3i cell;  // of which it is the centre along the other two
  std::uint32_t triangle, axis;

  Eigen::Vector3d position(double edge) const {
    Eigen::Vector3d p = (cell.cast<double>() + 0.5) * edge;
    p[axis] = height;
    return p;
  }
};

/// Which columns of cells are sampled: all, or after so many halvings every second (as on a
/// chessboard), fourth, eighth of them. What coarser ones have is part of every finer one, and all
/// triangles share them.
class Columns {
 public:
  explicit Columns(int halvings)
      : column_shift_((halvings + 1) / 2),
        row_step_(1 << halvings / 2),
        column_step_(1 << column_shift_) {}
  std::int32_t row_step() const { return row_step_; }
  std::int32_t column_step() const { return column_step_; }
  /// The first of those rows from `row` on.
  std::int32_t first_row(std::int32_t row) const { return next(row, row_step_, 0); }
  std::int32_t first_column(std::int32_t column, std::int32_t row) const {
    const bool shifted = column_step_ > row_step_ && (row & row_step_) != 0;
    return next(column, column_step_, shifted ? row_step_ : 0);
  }
  /// How many there are from one of those columns on up to before `end`; none or less than none if
  /// that is not behind it.
  std::int32_t columns_between(std::int32_t column, std::int32_t end) const {
    return (end - column + column_step_ - 1) >> column_shift_;
  }

 private:
  /// The first number from `at` on that is `shift` more than a multiple of `step`, a power of two.
  static std::int32_t next(std::int32_t at, std::int32_t step, std::int32_t shift) {
    return ((at - shift + step - 1) & -step) + shift;
  }
  int column_shift_;
  std::int32_t row_step_, column_step_;
};

/// Whether cells have a point already; fast where one is near the one before.
class TakenCells {
 public:
  explicit TakenCells(const SampleGrid& grid) : grid_(grid) {}

  /// @param p_grid  in the cell
  bool operator()(const Eigen::Array3i& cell, const Eigen::Vector3d& p_grid) {
    return is_marked(cell) || grid_.taken(p_grid);
  }
  /// Whether it is marked in a brick of the grid.
  bool is_marked(const Eigen::Array3i& cell) {
    const Eigen::Array3i number = CellBrick::number_of(cell);
    if (!CellBrick::same(number, number_)) {
      static constexpr CellBrick kEmpty{};
      number_ = number;
      brick_ = grid_.taken_brick(number);
      if (brick_ == nullptr) brick_ = &kEmpty;
    }
    return brick_->test(cell);
  }

 private:
  const SampleGrid& grid_;
  Eigen::Array3i number_ = CellBrick::no_number();  // of the brick last asked for
  const CellBrick* brick_ = nullptr;
};

/// The samples of some triangles whose cells have no point yet. Triangles have a few cells each,
/// of which nobody could foresee which are free: some hundred of many triangles take a step
/// together, and what goes is written over, so that few branches are left to guess.
class FreeSamples {
 public:
  FreeSamples(const SampleGrid& grid, const Cells& cells)
      : grid_(grid), cells_(cells), taken_(grid) {
    samples_.reserve(kUsual);
  }

  /// Adds samples at the centres of cells that fall onto a triangle when looked at along `axis`.
  void add(const std::array<Eigen::Vector3d, 3>& corner, std::uint32_t triangle, Eigen::Index axis,
           const Columns& sampled) {
    switch (axis) {
      case 0:
        return add_along<0>(corner, triangle, sampled);
      case 1:
        return add_along<1>(corner, triangle, sampled);
      default:
        return add_along<2>(corner, triangle, sampled);
    }
  }

  std::vector<Sample> take() && {
    keep_free();
    return std::move(samples_);
  }

 private:
  static constexpr std::size_t kUsual = 4096;  // samples that there will be room for
  static constexpr std::size_t kSize = 256;    // cells of a block
  static constexpr int kWide = 4;              // so many are put at once
  template <class T>
  using Row = std::array<T, kSize + kWide>;
  template <class T>
  using Wide = Eigen::Array<T, kWide, 1>;

  template <std::uint32_t kAxis>
  void add_along(const std::array<Eigen::Vector3d, 3>& corner, std::uint32_t triangle,
                 const Columns& sampled) {
    constexpr int kU = (kAxis + 1) % 3, kV = (kAxis + 2) % 3;
    const Eigen::Vector3d n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (!(n[kAxis] * n[kAxis] > 1e-6 * n.squaredNorm())) return;  // seen from its edge
    const double slope_u = -n[kU] / n[kAxis], slope_v = -n[kV] / n[kAxis];
    const double cell = cells_.edge;
    // By v: an edge that two triangles share is the same for both, and each row crosses the long
    // one and one of the others.
    const Eigen::Vector3d *low = &corner[0], *middle = &corner[1], *high = &corner[2];
    if ((*middle)[kV] < (*low)[kV]) std::swap(low, middle);
    if ((*high)[kV] < (*middle)[kV]) std::swap(middle, high);
    if ((*middle)[kV] < (*low)[kV]) std::swap(low, middle);
    const double low_u = (*low)[kU], low_v = (*low)[kV], middle_u = (*middle)[kU],
                 middle_v = (*middle)[kV];
    const double along_long = ((*high)[kU] - low_u) / ((*high)[kV] - low_v),
                 along_lower = (middle_u - low_u) / (middle_v - low_v),
                 along_upper = ((*high)[kU] - middle_u) / ((*high)[kV] - middle_v);
    const double at_origin = (*low)[kAxis] - slope_u * low_u - slope_v * low_v;
    const std::int32_t rows = cells_.first_center((*high)[kV]), step = sampled.column_step();
    const Wide<std::int32_t> whole_offsets = step * Wide<std::int32_t>(0, 1, 2, 3);
    const Wide<double> offsets = whole_offsets.cast<double>();
    for (std::int32_t row = sampled.first_row(cells_.first_center(low_v)); row < rows;
         row += sampled.row_step()) {
      const double at_v = (row + 0.5) * cell;
      const double first = low_u + (at_v - low_v) * along_long;
      const double second = at_v < middle_v ? low_u + (at_v - low_v) * along_lower
                                            : middle_u + (at_v - middle_v) * along_upper;
      const std::int32_t columns = cells_.first_center(std::max(first, second));
      const double at_row = at_origin + slope_v * at_v;
      std::int32_t column = sampled.first_column(cells_.first_center(std::min(first, second)), row);
      std::int32_t left = sampled.columns_between(column, columns);
      for (;; column += kWide * step, left -= kWide) {
        const Wide<double> at_u = ((column + 0.5) + offsets) * cell;
        const Wide<double> height = at_row + slope_u * at_u;
        put(height, height_);
        put(cells_.number(height), cell_[kAxis]);
        put(column + whole_offsets, cell_[kU]);
        put(Wide<std::int32_t>::Constant(row), cell_[kV]);
        put(Wide<std::uint32_t>::Constant(triangle), triangle_);
        put(Wide<std::uint32_t>::Constant(kAxis), axis_);
        count_ += static_cast<std::size_t>(std::clamp(left, 0, kWide));
        if (count_ >= kSize) keep_free();
        if (left <= kWide) break;
      }
    }
  }

  /// Writes values behind those of the block.
  template <class T, class Values>
  void put(const Values& values, Row<T>& row) {
    Eigen::Map<Wide<T>> place(&row[count_]);
    place = values;
  }

  /// Takes over what is free of the block, and empties it.
  void keep_free() {
    std::size_t free = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      free_[free] = static_cast<std::uint16_t>(i);
      free += !taken_.is_marked({cell_[0][i], cell_[1][i], cell_[2][i]});
    }
    for (std::size_t k = 0; k < free; ++k) {
      const std::size_t i = free_[k];
      const Sample sample{
          height_[i], {cell_[0][i], cell_[1][i], cell_[2][i]}, triangle_[i], axis_[i]};
      if (!grid_.taken(sample.position(grid_.cell))) samples_.push_back(sample);
    }
    count_ = 0;
  }

  const SampleGrid& grid_;
  const Cells& cells_;
  TakenCells taken_;
  Row<double> height_;
  std::array<Row<std::int32_t>, 3> cell_;
  Row<std::uint32_t> triangle_, axis_;
  std::size_t count_ = 0;
  Row<std::uint16_t> free_;  // places in the block
  std::vector<Sample> samples_;
};

/// Finds the samples of a surface by chunks of its triangles, which may be asked side by side.
class SurfaceSampler {
 public:
  SurfaceSampler(const Surface& surface, const SampleGrid& grid)
      : surface_(surface),
        grid_(grid),
        cells_(grid),
        R_grid_cam_(grid.T_grid_cam.linear().cast<float>()),
        vertex_(surface.mesh.position.size()) {
    parallel_for(vertex_.size(), kSampleGrain, [&](std::size_t v) {
      vertex_[v] = grid.T_grid_cam * surface.mesh.position[v].cast<double>();
    });
  }

  std::size_t chunks() const { return (surface_.triangles.size() + kGrain - 1) / kGrain; }

  /// Those of a chunk whose cells have no point yet.
  std::vector<Sample> samples(std::size_t chunk) const {
    FreeSamples samples(grid_, cells_);
    const std::size_t end = std::min(surface_.triangles.size(), (chunk + 1) * kGrain);
    for (std::size_t t = chunk * kGrain; t < end; ++t) {
      const auto& [a, b, c] = surface_.triangles[t];
      Eigen::Index axis;
      (R_grid_cam_ * surface_.triangle_normal[t]).cwiseAbs().maxCoeff(&axis);
      samples.add({vertex_[a], vertex_[b], vertex_[c]}, static_cast<std::uint32_t>(t), axis,
                  Columns(surface_.halvings[t]));
    }
    return std::move(samples).take();
  }

 private:
  const Surface& surface_;
  const SampleGrid& grid_;
  Cells cells_;
  Eigen::Matrix3f R_grid_cam_;
  std::vector<Eigen::Vector3d> vertex_;  // in the grid's frame
};

PointCloud measured_points(const PointCloud& points_cam, const Surface& surface,
                           const SampleGrid& grid, CellSet& cells) {
  std::vector<std::uint32_t> kept;
  TakenCells taken(grid);
  const CellNumber cell_number(grid);
  for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
    const Eigen::Vector3d p_grid = grid.T_grid_cam * points_cam.position[i].cast<double>();
    const Eigen::Array3i cell = cell_number(Eigen::Array3d(p_grid));
    if (!taken(cell, p_grid) && cells.mark(cell)) kept.push_back(i);
  }
  PointCloud points = points_cam.select(kept);
  points.normal.clear();
  for (const std::uint32_t i : kept) {
    const std::int32_t vertex = surface.mesh.vertex_of_point[i];
    points.normal.push_back(vertex == ImageMesh::kNoVertex
                                ? Eigen::Vector3f::Zero()
                                : surface.vertex_normal[static_cast<std::size_t>(vertex)]);
  }
  points.interpolated.assign(kept.size(), 0);
  points.reason.assign(kept.size(), reason_of(PointRule::kMeasured));
  return points;
}

float mean_intensity(const PointCloud& points, const Surface& surface, std::size_t triangle) {
  if (points.intensity.empty()) return 0;
  float sum = 0;
  for (const std::int32_t vertex : surface.triangles[triangle]) {
    sum += points.intensity[surface.mesh.point_of_vertex[static_cast<std::size_t>(vertex)]];
  }
  return sum / 3;
}

/// What all samples of a triangle share, found once for those that follow each other.
class TriangleValues {
 public:
  TriangleValues(const PointCloud& points_cam, const Surface& surface)
      : points_(points_cam), surface_(surface) {}
  void of(std::uint32_t triangle) {
    if (triangle == triangle_) return;
    triangle_ = triangle;
    normal = surface_.triangle_normal[triangle];
    intensity = mean_intensity(points_, surface_, triangle);
  }
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float intensity = 0;

 private:
  const PointCloud& points_;
  const Surface& surface_;
  std::uint32_t triangle_ = ~0u;
};

}  // namespace

PointCloud sample_surface(const PointCloud& points_cam, const Surface& surface,
                          const SampleGrid& grid) {
  CellSet cells;
  PointCloud points = measured_points(points_cam, surface, grid, cells);
  const SurfaceSampler sampler(surface, grid);
  std::vector<std::vector<Sample>> chunks(sampler.chunks());
  std::vector<const Sample*> samples;  // one a cell, the first; none where a point was measured
  parallel_in_order(
      chunks.size(), [&](std::size_t i) { chunks[i] = sampler.samples(i); },
      [&](std::size_t i) {
        for (const Sample& sample : chunks[i]) {
          if (cells.mark(sample.cell)) samples.push_back(&sample);
        }
      });

  const std::size_t measured = points.size(), all = measured + samples.size();
  points.position.resize(all);
  points.normal.resize(all);
  points.interpolated.resize(all, 1);
  points.reason.resize(all);
  if (!points_cam.intensity.empty()) points.intensity.resize(all);
  const RigidMotion T_cam_grid = grid.T_grid_cam.inverse();
  parallel_chunks(samples.size(), kSampleGrain, [&](std::size_t begin, std::size_t end) {
    TriangleValues values(points_cam, surface);
    for (std::size_t k = begin; k < end; ++k) {
      const Sample& sample = *samples[k];
      const std::size_t i = measured + k;
      values.of(sample.triangle);
      points.position[i] = (T_cam_grid * sample.position(grid.cell)).cast<float>();
      points.normal[i] = values.normal;
      points.reason[i] = reason_of(surface.rule[sample.triangle]);
      if (!points.intensity.empty()) points.intensity[i] = values.intensity;
    }
  });
  return points;
}

PointCloud sample_surfaces(const PointCloud& points_cam, const Camera& camera,
                           const SurfaceOptions& options, const SampleGrid& grid) {
  return sample_surface(points_cam, find_surface(points_cam, camera, options), grid);
}

}  // namespace fovea
