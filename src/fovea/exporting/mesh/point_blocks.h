// The points of one level of detail by blocks, in a scratch file: memory does not grow with them.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "fovea/core/scratch_file.h"
#include "fovea/exporting/mesh/mesh_lattice.h"
#include "fovea/exporting/mesh/seen_points.h"

namespace fovea {

class PointBlocks {
 public:
  /// @param voxel  edge of the level's voxels, m
  /// OutputError if there is no room for temporary files.
  explicit PointBlocks(double voxel) : voxel_(voxel), file_(std::make_unique<ScratchFile>()) {}

  double voxel() const { return voxel_; }
  double cell() const { return voxel_ / kVoxelCells; }
  /// OutputError as above.
  void append(const BlockKey& key, const std::vector<SeenPoint>& points);
  /// In the order in which they came; none for a block that has none.
  std::vector<SeenPoint> read(const BlockKey& key) const;
  /// The blocks that have points or lie within a voxel of some: all that surface can be in. In
  /// order.
  std::vector<BlockKey> keys() const;

 private:
  double voxel_;
  std::unique_ptr<ScratchFile> file_;
  std::map<BlockKey, std::vector<ScratchFile::Place>> places_;
};

}  // namespace fovea
