#include "fovea/geometry/point_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

namespace fovea {
namespace {

/// A cell is taken for this much nearer than computed, so that rounding loses nothing in it.
constexpr float kRounding = 0.9999f;
constexpr float kNowhere = 1e15f;  // m; its square is still a number
constexpr std::uint32_t kNobody = 0xffffffffu;

constexpr std::size_t kAtOnce = 8;  // blocks

}  // namespace

void PointGrid::Block::put(std::size_t lane, const Eigen::Vector3f& p, std::uint32_t number) {
  x[lane] = p.x();
  y[lane] = p.y();
  z[lane] = p.z();
  index[lane] = number;
}

PointGrid::PointGrid(std::span<const Eigen::Vector3f> points, float cell) : PointGrid(cell) {
  for (std::uint32_t i = 0; i < points.size(); ++i) insert(i, points[i]);
}

void PointGrid::insert(std::uint32_t index, const Eigen::Vector3f& p) {
  const std::uint32_t id = table_.insert(table_.voxel_of(p));
  if (id == cells_.size()) cells_.emplace_back();
  Cell& cell = cells_[id];
  const std::size_t lane = cell.count++ % kLanes;
  if (lane == 0) {
    const Lanes nowhere = all_lanes(kNowhere);
    cell.blocks.push_back({nowhere, nowhere, nowhere, {}});
  }
  cell.blocks.back().put(lane, p, index);
}

void PointGrid::erase(std::uint32_t index, const Eigen::Vector3f& p) {
  const std::uint32_t id = table_.find(table_.voxel_of(p));
  if (id != VoxelTable::kNone) {
    Cell& cell = cells_[id];
    for (std::size_t i = 0; i < cell.count; ++i) {
      Block& block = cell.blocks[i / kLanes];
      if (block.index[i % kLanes] != index) continue;
      // The last point takes its place.
      Block& last = cell.blocks.back();
      const std::size_t lane = --cell.count % kLanes;
      block.put(i % kLanes, last.point(lane), last.index[lane]);
      last.put(lane, Eigen::Vector3f::Constant(kNowhere), 0);
      if (lane == 0) cell.blocks.pop_back();
      return;
    }
  }
  throw std::logic_error("a point that is not in the grid cannot be removed from it");
}

void PointGrid::take(const Best& found, Best& best) {
  const auto place = [](const Best& b) {
    return std::tuple(b.squared_distance, b.point.x(), b.point.y(), b.point.z(), b.index);
  };
  if (best.index == kNobody || place(found) < place(best)) best = found;
}

void PointGrid::look_into(const VoxelTable::Voxel& cell, const Eigen::Vector3f& query,
                          Best& best) const {
  const std::uint32_t id = table_.find(cell);
  if (id == VoxelTable::kNone) return;
  const std::span<const Block> blocks(cells_[id].blocks);
  std::array<Lanes, kAtOnce> squared;
  for (std::size_t first = 0; first < blocks.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, blocks.size() - first);
    Lanes least = all_lanes(kNowhere);
    for (std::size_t k = 0; k < count; ++k) {
      const Block& block = blocks[first + k];
      const Lanes dx = block.x - query.x(), dy = block.y - query.y(), dz = block.z - query.z();
      squared[k] = dx * dx + dy * dy + dz * dz;
      least = min_of(least, squared[k]);
    }
    // Which point it is, is asked last: most blocks have none.
    const float nearest = min_of_lanes(least);
    if (!(nearest <= best.squared_distance)) continue;
    for (std::size_t k = 0; k < count; ++k) {
      const Block& block = blocks[first + k];
      for (unsigned bits = bits_of(squared[k] == nearest); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        take({nearest, block.point(lane), block.index[lane]}, best);
      }
    }
  }
}

Neighbor PointGrid::nearest(const Eigen::Vector3f& query, float max_distance) const {
  // Whatever is at max_distance itself counts.
  Best best{max_distance * max_distance, query, kNobody};
  const VoxelTable::Voxel own = table_.voxel_of(query);
  look_into(own, query, best);  // most often it is here, and little else is to be looked at
  const float reach = std::sqrt(best.squared_distance / kRounding);
  const VoxelTable::Voxel low = table_.voxel_of(query.array() - reach);
  const VoxelTable::Voxel high = table_.voxel_of(query.array() + reach);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const VoxelTable::Voxel cell(x, y, z);
        if (cell == own) continue;
        const Eigen::Array3f corner = cell.cast<float>().array() * cell_;
        const Eigen::Array3f gap =
            (corner - query.array()).max(query.array() - corner - cell_).max(0.0f);
        if (gap.matrix().squaredNorm() * kRounding > best.squared_distance) continue;
        look_into(cell, query, best);
      }
    }
  }
  if (best.index == kNobody) return {kNobody, std::numeric_limits<float>::infinity()};
  return {best.index, best.squared_distance};
}

}  // namespace fovea
