#include "fovea/upsample.h"

#include <array>
#include <type_traits>
#include <vector>

#include "fovea/geometry/transform_cloud.h"
#include "fovea/mapping/image_mesh.h"

namespace fovea {
namespace {

// A point that shares a grid point has the normal of the vertex up to this distance (m).
constexpr float kSameSurface = 0.05f;

// The mesh with the columns of upsampling, by vertex.
struct DenseMesh : ImageMesh {
  using ImageMesh::ImageMesh;
  std::vector<Eigen::Vector3f> normal;
  std::vector<DelaunayTriangulation::Vertices> corners;  // by interpolated vertex
};

void find_normals(DenseMesh& mesh, const GridProjection& project, float max_edge_squared) {
  mesh.normal.assign(mesh.position.size(), Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t < mesh.triangulation.triangle_count(); ++t) {
    if (!mesh.triangulation.is_finite(t)) continue;
    const auto corners = mesh.triangulation.vertices(t);
    if (!mesh.edges_below(corners, max_edge_squared)) continue;
    const Eigen::Vector3f normal = mesh.area_normal(corners, project);
    for (const std::int32_t corner : corners) mesh.normal[corner] += normal;
  }
  for (Eigen::Vector3f& normal : mesh.normal) normal = unit_or_zero(normal);
}

Eigen::Vector3f centroid(const DenseMesh& mesh, const DelaunayTriangulation::Vertices& corners) {
  return (mesh.position[corners[0]] + mesh.position[corners[1]] + mesh.position[corners[2]]) / 3.f;
}

// One rate: the centroids of all present triangles.
void insert_centroids(DenseMesh& mesh, const GridProjection& project, float max_edge_squared) {
  std::vector<GridPoint> pixels;
  std::vector<std::int32_t> triangles;
  std::vector<DelaunayTriangulation::Vertices> corners;
  std::vector<Eigen::Vector3f> centroids;
  pixels.reserve(mesh.triangulation.triangle_count());
  triangles.reserve(pixels.capacity());
  corners.reserve(pixels.capacity());
  centroids.reserve(pixels.capacity());
  for (std::size_t t = 0; t < mesh.triangulation.triangle_count(); ++t) {
    if (!mesh.triangulation.is_finite(t)) continue;
    const auto candidate = mesh.triangulation.vertices(t);
    if (!mesh.edges_below(candidate, max_edge_squared)) continue;
    const Eigen::Vector3f middle = centroid(mesh, candidate);
    const auto pixel = project(middle);
    if (!pixel) continue;
    pixels.push_back(*pixel);
    triangles.push_back(static_cast<std::int32_t>(t));
    corners.push_back(candidate);
    centroids.push_back(middle);
  }
  const std::vector<std::uint32_t> inserted = mesh.triangulation.insert(pixels, triangles);
  mesh.position.reserve(mesh.position.size() + inserted.size());
  mesh.normal.reserve(mesh.normal.size() + inserted.size());
  mesh.corners.reserve(mesh.corners.size() + inserted.size());
  for (const std::uint32_t i : inserted) {
    mesh.position.push_back(centroids[i]);
    mesh.normal.push_back(unit_or_zero(mesh.area_normal(corners[i], project)));
    mesh.corners.push_back(corners[i]);
  }
}

// Adds the interpolated entries of a column: the mean of three corners for quantities, otherwise
// the value of the first corner.
template <class T>
void extend(std::vector<T>& column, const std::vector<std::array<std::uint32_t, 3>>& corners) {
  if (column.empty()) return;
  column.reserve(column.size() + corners.size());
  for (const auto& [a, b, c] : corners) {
    if constexpr (std::is_same_v<T, float>) {
      column.push_back((column[a] + column[b] + column[c]) / 3.f);
    } else {
      column.push_back(column[a]);
    }
  }
}

std::vector<Eigen::Vector3f> normals_of_points(const PointCloud& points, const DenseMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(points.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int32_t vertex = mesh.vertex_of_point[i];
    if (vertex != ImageMesh::kNoVertex &&
        (points.position[i] - mesh.position[vertex]).norm() <= kSameSurface) {
      normals[i] = mesh.normal[vertex];
    }
  }
  return normals;
}

PointCloud to_cloud(const PointCloud& points, const DenseMesh& mesh) {
  const std::size_t measured = mesh.point_of_vertex.size();
  const auto point_of = [&](std::int32_t vertex) -> std::uint32_t {
    const auto v = static_cast<std::size_t>(vertex);
    return v < measured ? mesh.point_of_vertex[v]
                        : static_cast<std::uint32_t>(points.size() + (v - measured));
  };
  std::vector<std::array<std::uint32_t, 3>> corners;
  corners.reserve(mesh.corners.size());
  for (const auto& [a, b, c] : mesh.corners) {
    corners.push_back({point_of(a), point_of(b), point_of(c)});
  }

  PointCloud cloud = points;
  extend(cloud.intensity, corners);
  extend(cloud.range, corners);
  extend(cloud.incidence, corners);
  extend(cloud.color, corners);
  extend(cloud.sensor, corners);
  extend(cloud.frame, corners);
  extend(cloud.camera, corners);
  const auto first = static_cast<std::ptrdiff_t>(measured);
  cloud.position.insert(cloud.position.end(), mesh.position.begin() + first, mesh.position.end());
  cloud.normal = normals_of_points(points, mesh);
  cloud.normal.insert(cloud.normal.end(), mesh.normal.begin() + first, mesh.normal.end());
  cloud.interpolated.resize(points.size(), 0);
  cloud.interpolated.resize(cloud.position.size(), 1);
  cloud.reason.resize(points.size(), reason_of(PointRule::kMeasured));
  cloud.reason.resize(cloud.position.size(), reason_of(PointRule::kCentroid));
  return cloud;
}

}  // namespace

PointCloud upsample(const PointCloud& points_cam, const Camera& camera,
                    const UpsampleOptions& options) {
  points_cam.check();
  const GridProjection project(camera, points_cam.origin);
  const auto max_edge_squared = static_cast<float>(options.max_edge * options.max_edge);

  DenseMesh mesh(points_cam, project);
  find_normals(mesh, project, max_edge_squared);
  for (int i = 0; i < options.rate; ++i) insert_centroids(mesh, project, max_edge_squared);
  return to_cloud(points_cam, mesh);
}

std::vector<Eigen::Vector3f> upsample_non_ground(const PointCloud& scan_lidar,
                                                 const std::vector<std::uint8_t>& is_ground,
                                                 const std::vector<Camera>& cameras,
                                                 const UpsampleOptions& options) {
  std::vector<Eigen::Vector3f> result;
  std::vector<std::uint8_t> is_taken(scan_lidar.size(), 0);
  for (const Camera& camera : cameras) {
    const PointCloud points_cam = transform_cloud(scan_lidar, camera.T_cam_lidar);
    std::vector<std::uint32_t> rest;
    for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
      const auto pixel = camera.project(points_cam.position[i].cast<double>());
      if (is_taken[i] != 0 || !pixel || !camera.in_view(*pixel)) continue;
      is_taken[i] = 1;
      if (is_ground[i] != 0) {
        result.push_back(scan_lidar.position[i]);
      } else {
        rest.push_back(i);
      }
    }
    const PointCloud dense = upsample(points_cam.select(rest), camera, options);
    const PointCloud dense_lidar = transform_cloud(dense, camera.T_cam_lidar.inverse());
    result.insert(result.end(), dense_lidar.position.begin(), dense_lidar.position.end());
  }
  return result;
}

}  // namespace fovea
