// A map's surface, block by block, at several levels of detail.
#pragma once

#include <functional>

#include "fovea/exporting/mesh/mesh_patch.h"
#include "fovea/exporting/mesh/point_blocks.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea {

struct MeshOptions {
  PointChoice points = {};  ///< of local coordinates
  double voxel = 0.05;      ///< m, of the finest level, 0.01 to 10; twice the points' spacing
  bool force = false;       ///< replace an existing output

  /// ConfigError that names the field out of range.
  void validate() const;
};

struct MeshFigures : ExportFigures {
  std::size_t without_frame = 0;  ///< points whose frame, and so whose side, the map does not know
  std::size_t cells = 0;          ///< of half a voxel, that have points, at the finest level
  std::size_t lonely_cells = 0;   ///< of these, with too few others around for a surface
  std::size_t triangles = 0;      ///< of the finest level, without skirts
  std::size_t uncolored_vertices = 0;  ///< of the finest level: no coloured point near, so grey
};

/// The chosen points of a map by blocks of the finest level, and where these lie.
struct MapBlocks {
  PointBlocks points;
  /// The lattice's origin, local frame: no block of any level has a negative coordinate.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();

  Eigen::Vector3d corner(const BlockKey& key) const {
    return origin + block_edge(points.voxel()) * key.array().matrix().cast<double>();
  }
};

/// @param figures  gets without_frame
/// InputError if the map is damaged, OutputError if there is no room for temporary files.
MapBlocks map_blocks(const MapReader& map, const PointStream& points, double voxel,
                     MeshFigures& figures);

/// The same points for the next coarser level, one a cell and side.
PointBlocks coarser(const PointBlocks& points);

/// What is found on the way to a block's triangles.
struct BlockMesh {
  MeshPatch patch;
  std::size_t cells = 0, lonely_cells = 0;  ///< as MeshFigures
};
BlockMesh mesh_block(const PointBlocks& points, const BlockKey& key);

/// Calls f(key, mesh) for the blocks of a level in order; some are made at a time, in parallel.
void for_each_block_mesh(const PointBlocks& points,
                         const std::function<void(const BlockKey&, BlockMesh&)>& f);

/// Adds what a block of the finest level has.
void count_block(const BlockMesh& mesh, MeshFigures& figures);

}  // namespace fovea
