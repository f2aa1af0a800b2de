// Distance to the nearest true surface, and the albedo there.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "fovea/world/triangle_mesh.h"

namespace fovea {

/// Answers nearest-surface queries on a mesh (Embree point queries, exact distances in double).
class SurfaceIndex {
 public:
  /// Keeps a reference to the mesh. std::invalid_argument for an empty mesh.
  explicit SurfaceIndex(const TriangleMesh& mesh);
  ~SurfaceIndex();
  SurfaceIndex(SurfaceIndex&&) noexcept;

  /// Nearest point of the mesh; thread-safe, and the same for any number of threads (of equally
  /// near triangles the one of the lowest number).
  SurfacePoint nearest(const Eigen::Vector3d& p) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace fovea
