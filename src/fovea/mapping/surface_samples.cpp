#include "fovea/surface_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/geometry/cell_brick.h"
#include "fovea/mapping/surface.h"

namespace fovea {
namespace {

constexpr std::size_t kTriangleGrain = 512, kPointGrain = 4096;

struct Sample {
  Eigen::Vector3d p_grid;
  std::uint32_t triangle;
};

/// Cells that have a point of this scan, by level.
class MarkedCells {
 public:
  explicit MarkedCells(const SampleGrid& grid) : grid_(grid) {}
  /// @return whether the cell around the point is new
  bool mark(const Eigen::Vector3d& p_grid, int level) {
    const double cells_per_meter = 1 / (grid_.cell * (1 << level));
    const Eigen::Array3d cell =
        ((p_grid.array() + kStepsOn * grid_.step) * cells_per_meter).floor();
    return levels_[std::size_t(level)].mark(cell.cast<int>());
  }

 private:
  const SampleGrid& grid_;
  std::array<CellSet, kSamplingLevels> levels_;
};

/// Rounded to steps, and a little beyond: not on the border of a cell.
double rounded(double coordinate, double step) {
  return step == 0 ? coordinate : (std::floor(coordinate / step + 0.5) + kStepsOn) * step;
}

/// Appends the samples of a triangle in free cells.
void sample_triangle(std::array<const Eigen::Vector3d*, 3> corner, std::uint32_t triangle,
                     Eigen::Index axis, int level, const SampleGrid& grid,
                     std::vector<Sample>& samples) {
  const Eigen::Index u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
  const Eigen::Vector3d n = (*corner[1] - *corner[0]).cross(*corner[2] - *corner[0]);
  if (!(n[axis] * n[axis] > 1e-6 * n.squaredNorm())) return;  // parallel to the axis
  // Corners sorted by v, so that two triangles compute the same line for a common edge.
  std::sort(corner.begin(), corner.end(),
            [&](const auto* a, const auto* b) { return (*a)[v_axis] < (*b)[v_axis]; });
  const auto flat = [&](const Eigen::Vector3d& p) { return Eigen::Vector2d(p[u_axis], p[v_axis]); };
  const Eigen::Vector2d low = flat(*corner[0]), middle = flat(*corner[1]), high = flat(*corner[2]);
  const auto slope = [](const Eigen::Vector2d& edge) { return edge.x() / edge.y(); };
  const double along_long = slope(high - low), along_lower = slope(middle - low),
               along_upper = slope(high - middle);
  const double slope_u = -n[u_axis] / n[axis], slope_v = -n[v_axis] / n[axis];
  const double cell = grid.cell * (1 << level), cells_per_meter = 1 / cell;
  const auto first_center = [&](double at) {
    return static_cast<int>(std::ceil(at * cells_per_meter - 0.5));
  };
  const int rows = first_center(high.y());
  for (int row = first_center(low.y()); row < rows; ++row) {
    const double v = (row + 0.5) * cell;
    // The row crosses the longest edge and one of the others.
    const double first = low.x() + (v - low.y()) * along_long;
    const double second = v < middle.y() ? low.x() + (v - low.y()) * along_lower
                                         : middle.x() + (v - middle.y()) * along_upper;
    const int columns = first_center(std::max(first, second));
    for (int column = first_center(std::min(first, second)); column < columns; ++column) {
      const double u = (column + 0.5) * cell;
      const double height = (*corner[0])[axis] + slope_u * (u - low.x()) + slope_v * (v - low.y());
      Eigen::Vector3d p;
      p[u_axis] = u;
      p[v_axis] = v;
      p[axis] = rounded(height, grid.step);  // the others are far from their cells' borders
      if (!grid.taken(p, level)) samples.push_back({p, triangle});
    }
  }
}

std::vector<Eigen::Vector3d> vertices_in_grid(const Surface& surface, const SampleGrid& grid) {
  std::vector<Eigen::Vector3d> vertices(surface.mesh.position.size());
  parallel_for(vertices.size(), kPointGrain, [&](std::size_t v) {
    vertices[v] = grid.T_grid_cam * surface.mesh.position[v].cast<double>();
  });
  return vertices;
}

/// The samples of a range of triangles in free cells.
std::vector<Sample> sample_triangles(const Surface& surface, const SampleGrid& grid,
                                     const std::vector<Eigen::Vector3d>& vertices,
                                     std::size_t begin, std::size_t end) {
  const Eigen::Matrix3f R_grid_cam = grid.T_grid_cam.linear().cast<float>();
  std::vector<Sample> samples;
  for (std::size_t t = begin; t < end; ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Eigen::Vector3f normal = R_grid_cam * surface.triangle_normal[t];
    Eigen::Index axis;
    normal.cwiseAbs().maxCoeff(&axis);
    sample_triangle({&vertices[a], &vertices[b], &vertices[c]}, static_cast<std::uint32_t>(t), axis,
                    surface.level[t], grid, samples);
  }
  return samples;
}

/// The points in free cells. Marks these cells.
PointCloud measured_points(const PointCloud& points_cam, const Surface& surface,
                           const Camera& camera, const SurfaceOptions& options,
                           const SampleGrid& grid, MarkedCells& marked) {
  std::vector<std::uint32_t> kept;
  std::vector<Eigen::Vector3f> normals;
  std::vector<std::uint8_t> levels;
  for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
    const std::int32_t vertex = surface.mesh.vertex_of_point[i];
    const Eigen::Vector3f normal = vertex == ImageMesh::kNoVertex
                                       ? Eigen::Vector3f(Eigen::Vector3f::Zero())
                                       : surface.vertex_normal[static_cast<std::size_t>(vertex)];
    const Eigen::Vector3d p_cam = points_cam.position[i].cast<double>();
    // Off a surface: as if it faced the camera.
    const Eigen::Vector3d facing =
        normal.isZero(0) ? Eigen::Vector3d(p_cam.normalized()) : normal.cast<double>();
    const std::uint8_t level = sampling_level(p_cam, facing, camera, options);
    const Eigen::Vector3d p_grid = (grid.T_grid_cam * p_cam).unaryExpr([&](double coordinate) {
      return rounded(coordinate, grid.step);
    });
    if (grid.taken(p_grid, level) || !marked.mark(p_grid, level)) continue;
    kept.push_back(i);
    normals.push_back(normal);
    levels.push_back(level);
  }
  PointCloud points = points_cam.select(kept);
  points.normal = std::move(normals);
  points.sampling_level = std::move(levels);
  points.interpolated.assign(kept.size(), 0);
  points.reason.assign(kept.size(), reason_of(PointRule::kMeasured));
  return points;
}

float mean_intensity(const PointCloud& points, const Surface& surface, std::size_t triangle) {
  float sum = 0;
  for (const std::int32_t vertex : surface.triangles[triangle]) {
    sum += points.intensity[surface.mesh.point_of_vertex[static_cast<std::size_t>(vertex)]];
  }
  return sum / 3;
}

/// The LiDAR that measured the first corner of a triangle.
std::uint16_t sensor_of(const PointCloud& points, const Surface& surface, std::size_t triangle) {
  const auto vertex = static_cast<std::size_t>(surface.triangles[triangle].front());
  return points.sensor[surface.mesh.point_of_vertex[vertex]];
}

/// Appends the samples to `points`.
void add_samples(const PointCloud& points_cam, const Surface& surface, const SampleGrid& grid,
                 const std::vector<const Sample*>& samples, PointCloud& points) {
  const std::size_t measured = points.size(), all = measured + samples.size();
  points.position.resize(all);
  points.normal.resize(all);
  points.interpolated.resize(all, 1);
  points.reason.resize(all);
  points.sampling_level.resize(all);
  const bool has_intensity = !points_cam.intensity.empty();
  const bool has_sensor = !points_cam.sensor.empty();
  if (has_intensity) points.intensity.resize(all);
  if (has_sensor) points.sensor.resize(all);
  const RigidMotion T_cam_grid = grid.T_grid_cam.inverse();
  parallel_for(samples.size(), kPointGrain, [&](std::size_t k) {
    const Sample& sample = *samples[k];
    const std::size_t i = measured + k;
    points.position[i] = (T_cam_grid * sample.p_grid).cast<float>();
    points.normal[i] = surface.triangle_normal[sample.triangle];
    points.reason[i] = reason_of(surface.rule[sample.triangle]);
    points.sampling_level[i] = surface.level[sample.triangle];
    if (has_sensor) points.sensor[i] = sensor_of(points_cam, surface, sample.triangle);
    if (has_intensity) points.intensity[i] = mean_intensity(points_cam, surface, sample.triangle);
  });
}

}  // namespace

PointCloud sample_surfaces(const PointCloud& points_cam, const Camera& camera,
                           const SurfaceOptions& options, const SampleGrid& grid) {
  const Surface surface = find_surface(points_cam, camera, options);
  MarkedCells marked(grid);
  PointCloud points = measured_points(points_cam, surface, camera, options, grid, marked);
  const std::vector<Eigen::Vector3d> vertices = vertices_in_grid(surface, grid);
  const std::size_t triangles = surface.triangles.size();
  std::vector<std::vector<Sample>> chunks((triangles + kTriangleGrain - 1) / kTriangleGrain);
  std::vector<const Sample*> samples;  // the first one of each cell
  parallel_in_order(
      chunks.size(),
      [&](std::size_t i) {
        chunks[i] = sample_triangles(surface, grid, vertices, i * kTriangleGrain,
                                     std::min(triangles, (i + 1) * kTriangleGrain));
      },
      [&](std::size_t i) {
        for (const Sample& sample : chunks[i]) {
          if (marked.mark(sample.p_grid, surface.level[sample.triangle])) {
            samples.push_back(&sample);
          }
        }
      });
  add_samples(points_cam, surface, grid, samples, points);
  return points;
}

}  // namespace fovea
