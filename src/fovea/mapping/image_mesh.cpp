#include "fovea/mapping/image_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace fovea {
namespace {
constexpr double kGridPerPixel = 1024;
}

std::optional<GridPoint> GridProjection::operator()(const Eigen::Vector3f& position) const {
  const auto pixel = camera_.project(from_camera(position));
  if (!pixel) return std::nullopt;
  const double x = std::floor(kGridPerPixel * pixel->x() + 0.5);
  const double y = std::floor(kGridPerPixel * pixel->y() + 0.5);
  constexpr double kMax = kMaxGridCoordinate;
  if (!(std::abs(x) <= kMax && std::abs(y) <= kMax)) return std::nullopt;
  return GridPoint{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
}

ImageMesh::ImageMesh(const PointCloud& points, const GridProjection& project) {
  std::vector<GridPoint> pixels;
  std::vector<std::uint32_t> point_of_pixel;
  pixels.reserve(points.size());
  point_of_pixel.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (const auto pixel = project(points.position[i])) {
      pixels.push_back(*pixel);
      point_of_pixel.push_back(i);
    } else if (!(project.from_camera(points.position[i]).z() > Camera::kMinDepth)) {
      throw std::invalid_argument(fmt::format("point {} is not in front of the camera", i));
    }
  }
  const std::vector<std::int32_t> vertices = triangulation.insert(pixels);

  const auto squared_range = [&](std::uint32_t point) {
    return project.from_camera(points.position[point]).squaredNorm();
  };
  constexpr std::uint32_t kNoPoint = ~0u;
  vertex_of_point.assign(points.size(), kNoVertex);
  point_of_vertex.assign(triangulation.points().size(), kNoPoint);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    std::uint32_t& nearest = point_of_vertex[vertices[i]];
    if (nearest == kNoPoint || squared_range(point_of_pixel[i]) < squared_range(nearest)) {
      nearest = point_of_pixel[i];
    }
    vertex_of_point[point_of_pixel[i]] = vertices[i];
  }
  position.reserve(point_of_vertex.size());
  for (const std::uint32_t point : point_of_vertex) {
    position.push_back(points.position[point]);
  }
}

bool ImageMesh::edges_below(const DelaunayTriangulation::Vertices& corners,
                            float max_edge_squared) const {
  const Eigen::Vector3f &a = position[corners[0]], &b = position[corners[1]],
                        &c = position[corners[2]];
  return (a - b).squaredNorm() < max_edge_squared && (b - c).squaredNorm() < max_edge_squared &&
         (c - a).squaredNorm() < max_edge_squared;
}

Eigen::Vector3f ImageMesh::area_normal(const DelaunayTriangulation::Vertices& corners,
                                       const GridProjection& project) const {
  const Eigen::Vector3f &a = position[corners[0]], &b = position[corners[1]],
                        &c = position[corners[2]];
  const Eigen::Vector3f normal = (b - a).cross(c - a);
  return normal.dot(project.from_camera(a).cast<float>()) > 0 ? -normal : normal;
}

}  // namespace fovea
