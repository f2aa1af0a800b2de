#include "fovea/mapping/upsample.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "fovea/base/errors.h"
#include "fovea/mapping/delaunay.h"

namespace fovea {
namespace {

// Grid lines a pixel: far finer than a LiDAR measures, and 2^19 pixels still are on the grid.
constexpr double kGridPerPixel = 1024;

// A point that is not its pixel's vertex has that vertex's normal if it is at most this far away
// (m).
constexpr float kSameSurface = 0.05f;

constexpr std::int32_t kNoVertex = -1;

// The cloud's projection, triangulated. Columns are by vertex: measured ones first, then
// interpolated.
struct ImageMesh {
  DelaunayTriangulation triangulation;
  std::vector<Eigen::Vector3f> position;
  std::vector<Eigen::Vector3f> normal;
  std::vector<std::int32_t> vertex_of_point;  // by point of the cloud; kNoVertex far from the image
  std::vector<std::uint32_t> point_of_vertex;            // by measured vertex
  std::vector<DelaunayTriangulation::Vertices> corners;  // by interpolated vertex: of its triangle
};

class Projection {
 public:
  Projection(const Camera& camera, const Eigen::Vector3d& origin)
      : camera_(camera), origin_(origin) {}

  Eigen::Vector3d from_camera(const Eigen::Vector3f& position) const {
    return origin_ + position.cast<double>();
  }
  // Empty for what is not in front of the camera or beyond the grid.
  std::optional<GridPoint> operator()(const Eigen::Vector3f& position) const {
    const auto pixel = camera_.project(from_camera(position));
    if (!pixel) return std::nullopt;
    const double x = std::floor(kGridPerPixel * pixel->x() + 0.5);
    const double y = std::floor(kGridPerPixel * pixel->y() + 0.5);
    constexpr double kMax = kMaxGridCoordinate;
    if (!(std::abs(x) <= kMax && std::abs(y) <= kMax)) return std::nullopt;
    return GridPoint{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
  }

 private:
  const Camera& camera_;
  Eigen::Vector3d origin_;
};

ImageMesh triangulate_projection(const PointCloud& points, const Projection& project) {
  ImageMesh mesh;
  std::vector<GridPoint> pixels;
  std::vector<std::uint32_t> point_of_pixel;
  pixels.reserve(points.size());
  point_of_pixel.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (const auto pixel = project(points.position[i])) {
      pixels.push_back(*pixel);
      point_of_pixel.push_back(i);
    } else if (!(project.from_camera(points.position[i]).z() > Camera::kMinDepth)) {
      throw std::invalid_argument(
          fmt::format("upsample: point {} is not in front of the camera", i));
    }
  }
  const std::vector<std::int32_t> vertices = mesh.triangulation.insert(pixels);

  const auto squared_range = [&](std::uint32_t point) {
    return project.from_camera(points.position[point]).squaredNorm();
  };
  constexpr std::uint32_t kNoPoint = ~0u;
  mesh.vertex_of_point.assign(points.size(), kNoVertex);
  mesh.point_of_vertex.assign(mesh.triangulation.points().size(), kNoPoint);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    std::uint32_t& nearest = mesh.point_of_vertex[vertices[i]];
    if (nearest == kNoPoint || squared_range(point_of_pixel[i]) < squared_range(nearest)) {
      nearest = point_of_pixel[i];
    }
    mesh.vertex_of_point[point_of_pixel[i]] = vertices[i];
  }
  mesh.position.reserve(mesh.point_of_vertex.size());
  for (const std::uint32_t point : mesh.point_of_vertex) {
    mesh.position.push_back(points.position[point]);
  }
  return mesh;
}

bool edges_below(const ImageMesh& mesh, const DelaunayTriangulation::Vertices& corners,
                 float max_edge_squared) {
  const Eigen::Vector3f &a = mesh.position[corners[0]], &b = mesh.position[corners[1]],
                        &c = mesh.position[corners[2]];
  return (a - b).squaredNorm() < max_edge_squared && (b - c).squaredNorm() < max_edge_squared &&
         (c - a).squaredNorm() < max_edge_squared;
}

// Normal of a triangle, towards the camera; its length is twice the area.
Eigen::Vector3f area_normal(const ImageMesh& mesh, const DelaunayTriangulation::Vertices& corners,
                            const Projection& project) {
  const Eigen::Vector3f &a = mesh.position[corners[0]], &b = mesh.position[corners[1]],
                        &c = mesh.position[corners[2]];
  const Eigen::Vector3f normal = (b - a).cross(c - a);
  return normal.dot(project.from_camera(a).cast<float>()) > 0 ? -normal : normal;
}

Eigen::Vector3f unit_or_zero(const Eigen::Vector3f& v) {
  const float length = v.norm();
  return length > 0 ? Eigen::Vector3f(v / length) : Eigen::Vector3f::Zero();
}

void find_normals(ImageMesh& mesh, const Projection& project, float max_edge_squared) {
  mesh.normal.assign(mesh.position.size(), Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t < mesh.triangulation.triangle_count(); ++t) {
    if (!mesh.triangulation.is_finite(t)) continue;
    const auto corners = mesh.triangulation.vertices(t);
    if (!edges_below(mesh, corners, max_edge_squared)) continue;
    const Eigen::Vector3f normal = area_normal(mesh, corners, project);
    for (const std::int32_t corner : corners) mesh.normal[corner] += normal;
  }
  for (Eigen::Vector3f& normal : mesh.normal) normal = unit_or_zero(normal);
}

Eigen::Vector3f centroid(const ImageMesh& mesh, const DelaunayTriangulation::Vertices& corners) {
  return (mesh.position[corners[0]] + mesh.position[corners[1]] + mesh.position[corners[2]]) / 3.f;
}

// One rate: the centroids of all triangles that there are now.
void insert_centroids(ImageMesh& mesh, const Projection& project, float max_edge_squared) {
  std::vector<GridPoint> pixels;
  std::vector<std::int32_t> triangles;
  std::vector<DelaunayTriangulation::Vertices> corners;
  for (std::size_t t = 0; t < mesh.triangulation.triangle_count(); ++t) {
    if (!mesh.triangulation.is_finite(t)) continue;
    const auto candidate = mesh.triangulation.vertices(t);
    if (!edges_below(mesh, candidate, max_edge_squared)) continue;
    const auto pixel = project(centroid(mesh, candidate));
    if (!pixel) continue;
    pixels.push_back(*pixel);
    triangles.push_back(static_cast<std::int32_t>(t));
    corners.push_back(candidate);
  }
  for (const std::uint32_t i : mesh.triangulation.insert(pixels, triangles)) {
    mesh.position.push_back(centroid(mesh, corners[i]));
    mesh.normal.push_back(unit_or_zero(area_normal(mesh, corners[i], project)));
    mesh.corners.push_back(corners[i]);
  }
}

// Gives a column its interpolated entries: the mean of the three corners' for quantities, and the
// first corner's for what has no mean.
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

std::vector<Eigen::Vector3f> normals_of_points(const PointCloud& points, const ImageMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(points.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int32_t vertex = mesh.vertex_of_point[i];
    if (vertex != kNoVertex &&
        (points.position[i] - mesh.position[vertex]).norm() <= kSameSurface) {
      normals[i] = mesh.normal[vertex];
    }
  }
  return normals;
}

PointCloud to_cloud(const PointCloud& points, const ImageMesh& mesh) {
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
  extend(cloud.frame, corners);
  extend(cloud.camera, corners);
  const auto first = static_cast<std::ptrdiff_t>(measured);
  cloud.position.insert(cloud.position.end(), mesh.position.begin() + first, mesh.position.end());
  cloud.normal = normals_of_points(points, mesh);
  cloud.normal.insert(cloud.normal.end(), mesh.normal.begin() + first, mesh.normal.end());
  cloud.interpolated.resize(points.size(), 0);
  cloud.interpolated.resize(cloud.position.size(), 1);
  return cloud;
}

}  // namespace

void UpsampleOptions::validate() const {
  if (rate < 0 || rate > 5) {
    throw ConfigError(fmt::format("upsampling rate is {}", rate), "upsample.rate",
                      "give a number from 0 to 5");
  }
  if (!(max_edge > 0 && std::isfinite(max_edge))) {
    throw ConfigError(fmt::format("longest edge is {} m", max_edge), "upsample.max_edge",
                      "give a positive length");
  }
}

PointCloud upsample(const PointCloud& points_cam, const Camera& camera,
                    const UpsampleOptions& options) {
  options.validate();
  points_cam.check();
  const Projection project(camera, points_cam.origin);
  const auto max_edge_squared = static_cast<float>(options.max_edge * options.max_edge);

  ImageMesh mesh = triangulate_projection(points_cam, project);
  find_normals(mesh, project, max_edge_squared);
  for (int i = 0; i < options.rate; ++i) insert_centroids(mesh, project, max_edge_squared);
  return to_cloud(points_cam, mesh);
}

}  // namespace fovea
