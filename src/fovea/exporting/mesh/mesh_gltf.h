// Blocks of triangles as glTF 2.0.
#pragma once

#include <Eigen/Core>
#include <string>

#include "fovea/exporting/gltf.h"
#include "fovea/exporting/mesh/mesh_patch.h"

namespace fovea {

enum class MeshCoding {
  /// Positions in 16 bits on the vertices' own grid, normals in 8 (KHR_mesh_quantization): of a
  /// third of the bytes.
  kQuantised,
  /// Floats, which every reader knows.
  kPlain
};

/// A scene with a mesh a block, y up, unlit (KHR_materials_unlit; readers that do not know it are
/// told of a rough dielectric), colours in linear light, 16 bits.
class MeshGltf {
 public:
  explicit MeshGltf(MeshCoding coding) : coding_(coding) {}

  /// One more block.
  /// @param patch   of at least one triangle
  /// @param corner  its lowest corner, m, z up
  /// @param voxel   m
  /// @return what is to be appended to the file's binary chunk
  std::string add(const MeshPatch& patch, const Eigen::Vector3d& corner, double voxel);

  /// The bytes before the binary chunk's content: a whole file if there is no block.
  std::string head() const;
  /// Bytes of the binary chunk so far.
  std::size_t binary() const { return buffer_.bytes(); }

 private:
  struct Columns;
  Columns columns(const MeshPatch& patch, const Eigen::Vector3d& corner, double voxel) const;

  MeshCoding coding_;
  GltfBuffer buffer_;
  std::size_t count_ = 0;
  std::string nodes_, node_numbers_, meshes_;
};

}  // namespace fovea
