// The files of a known world: mesh, materials, names of surfaces (docs/simulator.md).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fovea/world/material.h"
#include "fovea/world/triangle_mesh.h"

namespace fovea {

/// The static part of a world. Moving things are not in it.
struct World {
  TriangleMesh mesh_local;                        ///< local = east-north-up of the truth's origin
  std::vector<Material> materials;                ///< that the mesh's triangles name
  std::map<std::uint32_t, std::string> surfaces;  ///< surface id -> kind ("house", "parked car")
};

/// Writes FOLDER/world.ply (binary little endian: vertices double x y z, float s t r; faces
/// uchar-counted int vertex_indices, ushort material, uint surface) and FOLDER/world.json
/// (materials, surfaces). OutputError.
void write_world(const World& world, const std::filesystem::path& folder);

/// Reads what write_world wrote. InputError if a file is missing or damaged.
World read_world(const std::filesystem::path& folder);

}  // namespace fovea
