#include "fovea/merging/known_surfaces.h"

#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/geometry/point_index.h"
#include "fovea/merging/place_points.h"

namespace fovea {
namespace {

constexpr float kBlock = 4;  // edge, m
constexpr std::size_t kGrain = 4096;

std::array<int, 3> block_of(const Eigen::Array3f& p_cell) {
  const Eigen::Array3i block = (p_cell / kBlock).floor().cast<int>();
  return {block.x(), block.y(), block.z()};
}

std::vector<Eigen::Vector3f> positions_in_cell(const TilePoints& points,
                                               const RigidMotion& T_cell_submap) {
  const Eigen::Matrix3f R = T_cell_submap.linear().cast<float>();
  const Eigen::Vector3f t = (T_cell_submap * points.origin).cast<float>();
  std::vector<Eigen::Vector3f> positions(points.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = R * points.position_at(i) + t;
  return positions;
}

}  // namespace

KnownSurfaces::Block KnownSurfaces::within(const Eigen::Array3f& low,
                                           const Eigen::Array3f& high) const {
  Block result;
  const std::array<int, 3> first = block_of(low), last = block_of(high);
  for (auto block = known_.lower_bound(first); block != known_.end(); ++block) {
    const auto& [key, points] = *block;
    if (key[0] > last[0]) break;
    if (key[1] < first[1] || key[1] > last[1] || key[2] < first[2] || key[2] > last[2]) continue;
    for (std::size_t i = 0; i < points.position_cell.size(); ++i) {
      const Eigen::Array3f p = points.position_cell[i].array();
      if ((p < low).any() || (p > high).any()) continue;
      result.position_cell.push_back(points.position_cell[i]);
      result.has_color.push_back(points.has_color[i]);
    }
  }
  return result;
}

std::vector<bool> KnownSurfaces::find(const TilePoints& points,
                                      const RigidMotion& T_cell_submap) const {
  std::vector<char> known(points.size());  // not bool: written by several threads
  const std::vector<Eigen::Vector3f> positions = positions_in_cell(points, T_cell_submap);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : positions) box.extend(p);
  if (positions.empty()) return {};
  const Block near = within(box.min().array() - kSameSurface, box.max().array() + kSameSurface);
  const PointIndex index(near.position_cell, kIndexSpacing);
  parallel_chunks(known.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Neighbor nearest = index.nearest(positions[i], kSameSurface);
      if (!std::isfinite(nearest.squared_distance)) continue;
      known[i] = shows_surface(nearest.squared_distance, near.has_color[nearest.index],
                               points.colors[i].views > 0, spacing_);
    }
  });
  return {known.begin(), known.end()};
}

void KnownSurfaces::add(const TilePoints& points, const RigidMotion& T_cell_submap) {
  const std::vector<Eigen::Vector3f> positions = positions_in_cell(points, T_cell_submap);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Block& block = added_[block_of(positions[i].array())];
    block.position_cell.push_back(positions[i]);
    block.has_color.push_back(points.colors[i].views > 0);
  }
}

void KnownSurfaces::end_drive() {
  for (auto& [key, added] : added_) {
    Block& block = known_[key];
    block.position_cell.insert(block.position_cell.end(), added.position_cell.begin(),
                               added.position_cell.end());
    block.has_color.insert(block.has_color.end(), added.has_color.begin(), added.has_color.end());
  }
  added_.clear();
}

}  // namespace fovea
