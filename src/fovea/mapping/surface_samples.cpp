#include "fovea/mapping/surface_samples.h"

#include <algorithm>
#include <array>

#include "fovea/core/parallel.h"
#include "fovea/mapping/triangle_sampler.h"

namespace fovea {
namespace {

constexpr std::size_t kTriangleGrain = 512, kPointGrain = 4096;

std::vector<Eigen::Vector3d> vertices_in_grid(const Surface& surface, const SampleGrid& grid) {
  std::vector<Eigen::Vector3d> vertices(surface.mesh.position.size());
  parallel_for(vertices.size(), kPointGrain, [&](std::size_t v) {
    vertices[v] = grid.T_grid_cam * surface.mesh.position[v].cast<double>();
  });
  return vertices;
}

/// Samples a range of triangles.
std::vector<TriangleSample> sample_triangles(const Surface& surface, const SampleGrid& grid,
                                             const std::vector<Eigen::Vector3d>& vertices,
                                             std::size_t begin, std::size_t end) {
  const Eigen::Matrix3f R_grid_cam = grid.T_grid_cam.linear().cast<float>();
  TriangleSampler sampler(grid);
  for (std::size_t t = begin; t < end; ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    Eigen::Index axis;
    (R_grid_cam * surface.triangle_normal[t]).cwiseAbs().maxCoeff(&axis);
    sampler.add({vertices[a], vertices[b], vertices[c]}, static_cast<std::uint32_t>(t), axis,
                ColumnStride(surface.halvings[t]));
  }
  return std::move(sampler).take();
}

/// Marks the cells of the points that it returns.
PointCloud measured_points(const PointCloud& points_cam, const Surface& surface,
                           const SampleGrid& grid, CellSet& marked) {
  std::vector<std::uint32_t> kept;
  GridCells cells(grid);
  for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
    const Eigen::Vector3d p_grid = grid.T_grid_cam * points_cam.position[i].cast<double>();
    const Eigen::Array3i cell = cells.numbers_of(Eigen::Array3d(p_grid));
    if (!cells.is_taken(cell, p_grid) && marked.mark(cell)) kept.push_back(i);
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
  float sum = 0;
  for (const std::int32_t vertex : surface.triangles[triangle]) {
    sum += points.intensity[surface.mesh.point_of_vertex[static_cast<std::size_t>(vertex)]];
  }
  return sum / 3;
}

/// Appends the samples to `points`.
void add_samples(const PointCloud& points_cam, const Surface& surface, const SampleGrid& grid,
                 const std::vector<const TriangleSample*>& samples, PointCloud& points) {
  const std::size_t measured = points.size(), all = measured + samples.size();
  points.position.resize(all);
  points.normal.resize(all);
  points.interpolated.resize(all, 1);
  points.reason.resize(all);
  const bool has_intensity = !points_cam.intensity.empty();
  if (has_intensity) points.intensity.resize(all);
  const RigidMotion T_cam_grid = grid.T_grid_cam.inverse();
  parallel_for(samples.size(), kPointGrain, [&](std::size_t k) {
    const TriangleSample& sample = *samples[k];
    const std::size_t i = measured + k;
    points.position[i] = (T_cam_grid * sample.position(grid.cell)).cast<float>();
    points.normal[i] = surface.triangle_normal[sample.triangle];
    points.reason[i] = reason_of(surface.rule[sample.triangle]);
    if (has_intensity) points.intensity[i] = mean_intensity(points_cam, surface, sample.triangle);
  });
}

}  // namespace

PointCloud sample_surface(const PointCloud& points_cam, const Surface& surface,
                          const SampleGrid& grid) {
  CellSet marked;
  PointCloud points = measured_points(points_cam, surface, grid, marked);
  const std::vector<Eigen::Vector3d> vertices = vertices_in_grid(surface, grid);
  const std::size_t triangles = surface.triangles.size();
  std::vector<std::vector<TriangleSample>> chunks((triangles + kTriangleGrain - 1) /
                                                  kTriangleGrain);
  std::vector<const TriangleSample*> samples;  // the first one of each cell
  parallel_in_order(
      chunks.size(),
      [&](std::size_t i) {
        chunks[i] = sample_triangles(surface, grid, vertices, i * kTriangleGrain,
                                     std::min(triangles, (i + 1) * kTriangleGrain));
      },
      [&](std::size_t i) {
        for (const TriangleSample& sample : chunks[i]) {
          if (marked.mark(sample.cell)) samples.push_back(&sample);
        }
      });
  add_samples(points_cam, surface, grid, samples, points);
  return points;
}

PointCloud sample_surfaces(const PointCloud& points_cam, const Camera& camera,
                           const SurfaceOptions& options, const SampleGrid& grid) {
  return sample_surface(points_cam, find_surface(points_cam, camera, options), grid);
}

}  // namespace fovea
