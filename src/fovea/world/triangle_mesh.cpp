#include "fovea/world/triangle_mesh.h"

#include <stdexcept>

namespace fovea {

Eigen::Vector3d TriangleMesh::normal(std::size_t t) const {
  const Eigen::Vector3d n = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  const double length = n.norm();
  return length > 0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::Zero();
}

void TriangleMesh::append(const TriangleMesh& other, const Eigen::Affine3d& T) {
  const auto first = static_cast<std::uint32_t>(position.size());
  for (const Eigen::Vector3d& p : other.position) position.push_back(T * p);
  for (const auto& [a, b, c] : other.triangle)
    triangle.push_back({a + first, b + first, c + first});
  const auto join = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  join(texture, other.texture);
  join(material, other.material);
  join(surface, other.surface);
}

void TriangleMesh::check() const {
  if (texture.size() != position.size()) {
    throw std::logic_error("mesh: texture and position differ in length");
  }
  if (material.size() != triangle.size() || surface.size() != triangle.size()) {
    throw std::logic_error("mesh: columns of the triangles differ in length");
  }
  for (const auto& corners : triangle) {
    for (const std::uint32_t v : corners) {
      if (v >= position.size()) throw std::logic_error("mesh: a triangle names no vertex");
    }
  }
}

namespace {

/// Weights (b, c) of the second and third corner at the point of triangle abc nearest to p.
std::pair<double, double> nearest_weights(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - w, w};
  }
  const double sum = va + vb + vc;
  return {vb / sum, vc / sum};
}

}  // namespace

SurfacePoint nearest_on_triangle(const TriangleMesh& mesh, std::uint32_t triangle,
                                 const Eigen::Vector3d& p) {
  const auto& corners = mesh.triangle.at(triangle);
  const Eigen::Vector3d &a = mesh.corner(triangle, 0), &b = mesh.corner(triangle, 1),
                        &c = mesh.corner(triangle, 2);
  const auto [v, w] = nearest_weights(p, a, b, c);
  const Eigen::Vector3f &ta = mesh.texture[corners[0]], &tb = mesh.texture[corners[1]],
                        &tc = mesh.texture[corners[2]];
  return {triangle, a + v * (b - a) + w * (c - a),
          ta + static_cast<float>(v) * (tb - ta) + static_cast<float>(w) * (tc - ta)};
}

}  // namespace fovea
