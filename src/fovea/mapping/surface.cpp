#include "fovea/mapping/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fovea {
namespace {

using Vertices = DelaunayTriangulation::Vertices;
/// Rounds of averaging normals over neighbors, against the noise of ranges.
constexpr int kSmoothing = 2;

std::size_t neighbor(const ImageMesh& mesh, std::size_t triangle, int corner) {
  return static_cast<std::size_t>(mesh.triangulation.neighbor(triangle, corner));
}

/// Normal of a triangle and its neighbors except one, as a sum of area vectors: only the noise of
/// the rim remains.
Eigen::Vector3f patch_normal(const ImageMesh& mesh, const std::vector<Eigen::Vector3f>& area,
                             std::size_t triangle, std::size_t without) {
  Eigen::Vector3f sum = area[triangle];
  for (int corner = 0; corner < 3; ++corner) {
    const std::size_t beyond = neighbor(mesh, triangle, corner);
    if (beyond != without) sum += area[beyond];
  }
  return unit_or_zero(sum);
}

/// Whether the surface continues straight across each edge of a triangle. The patches on both sides
/// share no triangle, since the large triangles across a gap in depth would outweigh the small ones
/// at its rim.
bool is_flat(const ImageMesh& mesh, const std::vector<Eigen::Vector3f>& area, std::size_t triangle,
             float cos_angle) {
  for (int corner = 0; corner < 3; ++corner) {
    const std::size_t beyond = neighbor(mesh, triangle, corner);
    if (area[beyond].isZero(0)) return false;
    const float cos_fold =
        patch_normal(mesh, area, triangle, beyond).dot(patch_normal(mesh, area, beyond, triangle));
    if (!(cos_fold > cos_angle)) return false;
  }
  return true;
}

/// @return the normal of each triangle, with the length of twice its area
std::vector<Eigen::Vector3f> find_triangles(const GridProjection& project,
                                            const SurfaceOptions& options, Surface& surface) {
  const ImageMesh& mesh = surface.mesh;
  const auto squared = [](double edge) { return static_cast<float>(edge * edge); };
  const float longest = squared(std::max(options.max_edge, options.planar_edge));
  std::vector<Eigen::Vector3f> area(mesh.triangulation.triangle_count(), Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t < area.size(); ++t) {
    if (!mesh.triangulation.is_finite(t)) continue;
    const Vertices& corners = mesh.triangulation.vertices(t);
    if (mesh.edges_below(corners, longest)) area[t] = mesh.area_normal(corners, project);
  }
  const auto cos_angle = static_cast<float>(std::cos(options.planar_angle));
  std::vector<Eigen::Vector3f> found;
  for (std::size_t t = 0; t < area.size(); ++t) {
    if (area[t].isZero(0)) continue;
    const Vertices& corners = mesh.triangulation.vertices(t);
    const bool is_short = mesh.edges_below(corners, squared(options.max_edge));
    if (!is_short && !is_flat(mesh, area, t, cos_angle)) continue;
    surface.triangles.push_back(corners);
    surface.rule.push_back(is_short ? PointRule::kShortEdges : PointRule::kPlanar);
    found.push_back(area[t]);
  }
  return found;
}

/// @param area  as find_triangles() returns it
void find_normals(const std::vector<Eigen::Vector3f>& area, Surface& surface) {
  std::vector<Eigen::Vector3f>& normal = surface.vertex_normal;
  normal.assign(surface.mesh.position.size(), Eigen::Vector3f::Zero());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const std::int32_t corner : surface.triangles[t]) normal[corner] += area[t];
  }
  for (Eigen::Vector3f& n : normal) n = unit_or_zero(n);
  for (int round = 0; round < kSmoothing; ++round) {
    std::vector<Eigen::Vector3f> sum = normal;
    for (const auto& [a, b, c] : surface.triangles) {
      const Eigen::Vector3f together = normal[a] + normal[b] + normal[c];
      for (const std::int32_t corner : {a, b, c}) sum[corner] += together;
    }
    for (std::size_t v = 0; v < sum.size(); ++v) normal[v] = unit_or_zero(sum[v]);
  }
  surface.triangle_normal.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles) {
    surface.triangle_normal.push_back(unit_or_zero(normal[a] + normal[b] + normal[c]));
  }
}

void find_levels(const GridProjection& project, const Camera& camera, const SurfaceOptions& options,
                 Surface& surface) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const std::vector<Eigen::Vector3f>& p = surface.mesh.position;
    surface.level.push_back(sampling_level(project.from_camera((p[a] + p[b] + p[c]) / 3),
                                           surface.triangle_normal[t].cast<double>(), camera,
                                           options));
  }
}

}  // namespace

std::uint8_t sampling_level(const Eigen::Vector3d& p_cam, const Eigen::Vector3d& normal,
                            const Camera& camera, const SurfaceOptions& options) {
  const bool is_far = p_cam.norm() > options.full_density_range;
  if (!is_far && options.max_per_pixel == 0) return 0;
  const double per_pixel = is_far ? 1 : options.max_per_pixel;
  // Area of a plane in a pixel, m^2.
  const double cubed = p_cam.z() * p_cam.z() * p_cam.z();
  const double area = cubed / (camera.fx * camera.fy * std::abs(normal.dot(p_cam)));
  int level = is_far ? 1 : 0;
  while (level + 1 < kSamplingLevels) {
    const double cell = options.spacing * (1 << level);
    if (!(area > 2 * per_pixel * cell * cell)) break;
    ++level;
  }
  return static_cast<std::uint8_t>(level);
}

Surface find_surface(const PointCloud& points_cam, const Camera& camera,
                     const SurfaceOptions& options) {
  points_cam.check();
  const GridProjection project(camera, points_cam.origin);
  Surface surface{ImageMesh(points_cam, project), {}, {}, {}, {}, {}};
  find_normals(find_triangles(project, options, surface), surface);
  find_levels(project, camera, options, surface);
  return surface;
}

}  // namespace fovea
