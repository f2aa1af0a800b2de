#include "fovea/simulation/mesh_builder.h"

#include <cmath>
#include <numbers>

namespace fovea {

using Eigen::Vector3d;
using Eigen::Vector3f;

std::uint32_t MeshBuilder::vertex(const Vector3d& p, const Vector3f& texture) {
  mesh_.position.push_back(frame * p);
  mesh_.texture.push_back(texture);
  return static_cast<std::uint32_t>(mesh_.position.size() - 1);
}

void MeshBuilder::face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh_.triangle.push_back({a, b, c});
  mesh_.material.push_back(material);
  mesh_.surface.push_back(surface);
}

void MeshBuilder::quad(const std::array<Vector3d, 4>& corners,
                       const std::array<Vector3f, 4>& texture) {
  std::uint32_t v[4];
  for (std::size_t k = 0; k < 4; ++k) v[k] = vertex(corners[k], texture[k]);
  face(v[0], v[1], v[2]);
  face(v[0], v[2], v[3]);
}

void MeshBuilder::quad(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d along = (b - a).normalized();
  const Vector3d up = (b - a).cross(d - a).cross(along).normalized();
  const auto at = [&](const Vector3d& p) -> Vector3f {
    return texture_origin + Vector3d((p - a).dot(along), (p - a).dot(up), 0).cast<float>();
  };
  quad({a, b, c, d}, {at(a), at(b), at(c), at(d)});
}

void MeshBuilder::triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d along = (b - a).normalized();
  const Vector3d up = (b - a).cross(c - a).cross(along).normalized();
  const auto at = [&](const Vector3d& p) -> Vector3f {
    return texture_origin + Vector3d((p - a).dot(along), (p - a).dot(up), 0).cast<float>();
  };
  const std::uint32_t va = vertex(a, at(a)), vb = vertex(b, at(b)), vc = vertex(c, at(c));
  face(va, vb, vc);
}

void MeshBuilder::box(const Vector3d& low, const Vector3d& high) {
  const auto p = [&](int x, int y, int z) {
    return Vector3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
  quad(p(1, 1, 0), p(0, 1, 0), p(0, 1, 1), p(1, 1, 1));
  quad(p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
  quad(p(0, 1, 0), p(0, 0, 0), p(0, 0, 1), p(0, 1, 1));
  quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
  quad(p(0, 1, 0), p(1, 1, 0), p(1, 0, 0), p(0, 0, 0));
}

void MeshBuilder::bar(const Vector3d& base, const Vector3d& top, double base_radius,
                      double top_radius, int sides) {
  const Vector3d axis = top - base;
  const Vector3d u = axis.unitOrthogonal(), v = axis.normalized().cross(u);
  const auto rim = [&](const Vector3d& center, double radius, int k) -> Vector3d {
    const double a = 2 * std::numbers::pi * k / sides;
    return center + radius * (std::cos(a) * u + std::sin(a) * v);
  };
  const double step = 2 * std::numbers::pi * base_radius / sides;
  for (int k = 0; k < sides; ++k) {
    const auto s0 = static_cast<float>(step * k), s1 = static_cast<float>(step * (k + 1));
    const auto t1 = static_cast<float>(axis.norm());
    quad({rim(base, base_radius, k), rim(base, base_radius, k + 1), rim(top, top_radius, k + 1),
          rim(top, top_radius, k)},
         {texture_origin + Vector3f(s0, 0, 0), texture_origin + Vector3f(s1, 0, 0),
          texture_origin + Vector3f(s1, t1, 0), texture_origin + Vector3f(s0, t1, 0)});
    triangle(top, rim(top, top_radius, k), rim(top, top_radius, k + 1));
    triangle(base, rim(base, base_radius, k + 1), rim(base, base_radius, k));
  }
}

void MeshBuilder::ball(const Vector3d& center, const Vector3d& radii, int sides) {
  const int rows = std::max(3, sides / 2);
  const auto at = [&](int row, int k) -> Vector3d {
    const double polar = std::numbers::pi * row / rows, a = 2 * std::numbers::pi * k / sides;
    return center + radii.cwiseProduct(Vector3d(std::sin(polar) * std::cos(a),
                                                std::sin(polar) * std::sin(a), -std::cos(polar)));
  };
  for (int row = 0; row < rows; ++row) {
    for (int k = 0; k < sides; ++k) {
      const Vector3d a = at(row, k), b = at(row, k + 1), c = at(row + 1, k + 1), d = at(row + 1, k);
      if (row == 0) {
        triangle(a, c, d);
      } else if (row == rows - 1) {
        triangle(a, b, c);
      } else {
        quad(a, b, c, d);
      }
    }
  }
}

}  // namespace fovea
