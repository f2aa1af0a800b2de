// Triangle meshes as binary PLY files (docs/simulator.md).
#pragma once

#include <filesystem>

#include "fovea/world/triangle_mesh.h"

namespace fovea {

/// What errors about a damaged world advise.
inline constexpr const char* kWorldRemedy = "write the world anew with 'fovea simulate'";

/// Writes a mesh: vertices double x y z, float s t r; faces uchar-counted int vertex_indices,
/// ushort material, uint surface. OutputError.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& file);

/// Reads what write_mesh wrote, and nothing else. InputError if it is missing or damaged; every
/// position is finite and every triangle names vertices.
TriangleMesh read_mesh(const std::filesystem::path& file);

}  // namespace fovea
