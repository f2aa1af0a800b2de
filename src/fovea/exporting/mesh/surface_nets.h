// Triangles of an implicit surface.
#pragma once

#include "fovea/exporting/mesh/implicit_surface.h"
#include "fovea/exporting/mesh/mesh_patch.h"
#include "fovea/exporting/mesh/surfels.h"

namespace fovea {

/// Surface nets (Gibson, Constrained Elastic Surface Nets, MICCAI 1998): a vertex in each voxel
/// that the surface crosses, and a quad around each edge of the lattice that it crosses; each side
/// of something thin has vertices of its own. A vertex is drawn onto the surface, and is there only
/// where a surfel is within three quarters of a voxel: nothing is made up where no points are.
///
/// A block has the quads of the edges that begin in it. Their vertices in voxels before the block
/// are bit for bit those of its neighbours: blocks of a level meet without a crack.
MeshPatch surface_nets(const Surfels& surfels, const ImplicitSurface& surface);

}  // namespace fovea
