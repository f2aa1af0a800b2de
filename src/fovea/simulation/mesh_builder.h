// Puts meshes together from quads, boxes and tubes.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "fovea/world/triangle_mesh.h"

namespace fovea {

/// Appends to a mesh. Everything is given in `frame`; texture coordinates are in metres from the
/// place that `texture_origin` says, so that neighbouring pieces do not repeat each other.
class MeshBuilder {
 public:
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();  ///< of what is given, in the mesh's
  std::uint16_t material = 0;
  std::uint32_t surface = 0;
  Eigen::Vector3f texture_origin = Eigen::Vector3f::Zero();

  /// Corners counter-clockwise seen from outside; s runs from a to b, t from a to d.
  void quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
            const Eigen::Vector3d& d);
  /// The same with texture coordinates of its own (not moved by texture_origin).
  void quad(const std::array<Eigen::Vector3d, 4>& corners,
            const std::array<Eigen::Vector3f, 4>& texture);
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  /// All six faces, outside, each textured in its own plane.
  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  /// A round bar with both ends; s runs round it (m at the base), t along it.
  void bar(const Eigen::Vector3d& base, const Eigen::Vector3d& top, double base_radius,
           double top_radius, int sides);
  /// A ball of `sides` meridians.
  void ball(const Eigen::Vector3d& center, const Eigen::Vector3d& radii, int sides);

  /// A mesh that is where it belongs already; nothing of it is changed.
  void append(const TriangleMesh& mesh) { mesh_.append(mesh, Eigen::Affine3d::Identity()); }

  TriangleMesh take() { return std::move(mesh_); }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  std::uint32_t vertex(const Eigen::Vector3d& p, const Eigen::Vector3f& texture);
  void face(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  TriangleMesh mesh_;
};

}  // namespace fovea
