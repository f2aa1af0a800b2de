// Surfaces of a known world: triangles with a material and the id of the thing they belong to.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// Triangles, as columns of equal length. Their frame is what the variable's name says
/// (`mesh_local`).
struct TriangleMesh {
  std::vector<Eigen::Vector3d> position;  ///< of the vertices (m)
  std::vector<Eigen::Vector3f> texture;   ///< of the vertices: where on (or in) the material (m)
  std::vector<std::array<std::uint32_t, 3>> triangle;  ///< vertices, counter-clockwise from outside
  std::vector<std::uint16_t> material;  ///< of the triangles: place in a list of Material
  std::vector<std::uint32_t>
      surface;  ///< of the triangles: id of the thing (house, car, road, ...)

  std::size_t size() const { return triangle.size(); }
  bool empty() const { return triangle.empty(); }

  /// Corner k of a triangle.
  const Eigen::Vector3d& corner(std::size_t t, int k) const {
    return position[triangle[t][static_cast<std::size_t>(k)]];
  }
  /// Unit normal of a triangle; zero where it has no area.
  Eigen::Vector3d normal(std::size_t t) const;

  /// Appends another mesh, moved by T. Surface ids and materials stay as they are.
  void append(const TriangleMesh& other, const Eigen::Affine3d& T);

  /// Throws std::logic_error if columns differ in length or a triangle names no vertex.
  void check() const;
};

/// A point on a mesh.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3f texture = Eigen::Vector3f::Zero();  ///< interpolated between the corners
};

/// The point of a triangle nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
SurfacePoint nearest_on_triangle(const TriangleMesh& mesh, std::uint32_t triangle,
                                 const Eigen::Vector3d& p);

}  // namespace fovea
