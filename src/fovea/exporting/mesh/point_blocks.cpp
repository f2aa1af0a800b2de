#include "fovea/exporting/mesh/point_blocks.h"

namespace fovea {
namespace {

/// -1, 0 or 1 on each axis: where the block's face is that a cell lies within a voxel of.
Eigen::Array3i side_of(const Eigen::Array3i& cell) {
  return (cell >= kBlockCells - kVoxelCells).cast<int>() - (cell < kVoxelCells).cast<int>();
}

}  // namespace

void PointBlocks::append(const BlockKey& key, const std::vector<SeenPoint>& points) {
  if (points.empty()) return;
  places_[key].push_back(file_->append(points));
  for (const SeenPoint& point : points) {
    const Eigen::Array3i side = side_of(cell_in_block(point, cell()));
    if ((side == 0).all()) continue;
    for (int axes = 1; axes < 8; ++axes) {  // across a face, an edge, the corner
      const Eigen::Array3i chosen(axes & 1, axes >> 1 & 1, axes >> 2);
      places_.try_emplace(BlockKey::of(key.array() + side * chosen));
    }
  }
}

std::vector<SeenPoint> PointBlocks::read(const BlockKey& key) const {
  std::vector<SeenPoint> points;
  const auto found = places_.find(key);
  if (found == places_.end()) return points;
  for (const ScratchFile::Place& place : found->second) {
    const std::vector<SeenPoint> part = file_->read<SeenPoint>(place);
    points.insert(points.end(), part.begin(), part.end());
  }
  return points;
}

std::vector<BlockKey> PointBlocks::keys() const {
  std::vector<BlockKey> keys;
  for (const auto& [key, places] : places_) keys.push_back(key);
  return keys;
}

}  // namespace fovea
