#include "fovea/exporting/mesh/surfels.h"

#include <algorithm>
#include <tuple>

#include "fovea/geometry/plane_moments.h"

namespace fovea {
namespace {

constexpr int kNormalReach = 3;     // cells
constexpr float kFewestAround = 4;  // points, with the one in the middle
/// Of the variance across the view ray that is added: it decides where points leave the plane open,
/// on a pole for instance, and turns the normal of a plane by half a degree at most.
constexpr float kSightShare = 0.01f;

static_assert(Surfels::kNormalMargin + kNormalReach < Surfels::kMargin);

bool within(const Eigen::Vector3i& cell, int margin) {
  return (cell.array() >= -margin).all() && (cell.array() < kBlockCells + margin).all();
}

/// The points of a block's neighbour, or itself, that lie near the block.
std::vector<SeenPoint> near_points(const PointBlocks& points, const BlockKey& block,
                                   const Eigen::Array3i& step) {
  std::vector<SeenPoint> near = points.read(BlockKey::of(block.array() + step));
  if ((step == 0).all()) return near;
  std::erase_if(near, [&](const SeenPoint& point) {
    const Eigen::Array3i cell = cell_in_block(point, points.cell()) + step * kBlockCells;
    return !within(cell.matrix(), Surfels::kMargin);
  });
  return near;
}

Surfel surfel_of(const SeenPoint& point, double cell, const Eigen::Array3i& step) {
  const Eigen::Array3i in_block = cell_in_block(point, cell);
  const Eigen::Vector3f place = position_of(point) / static_cast<float>(cell);
  return {(in_block + step * kBlockCells).matrix(),
          place - in_block.matrix().cast<float>(),
          direction_of(point),
          Eigen::Vector3f::Zero(),
          point.colored != 0,
          to_float(point.color)};
}

auto order_of(const Surfel& surfel) {
  return std::tuple(surfel.cell.z(), surfel.cell.y(), surfel.cell.x());
}

}  // namespace

Surfels::Surfels(const PointBlocks& points, const BlockKey& block) {
  Eigen::Array3i step;
  for (step.z() = -1; step.z() <= 1; ++step.z()) {
    for (step.y() = -1; step.y() <= 1; ++step.y()) {
      for (step.x() = -1; step.x() <= 1; ++step.x()) {
        for (const SeenPoint& point : thinned(near_points(points, block, step), points.cell())) {
          surfels_.push_back(surfel_of(point, points.cell(), step));
        }
      }
    }
  }
  std::stable_sort(surfels_.begin(), surfels_.end(),
                   [](const Surfel& a, const Surfel& b) { return order_of(a) < order_of(b); });
  for (std::size_t i = 0; i < surfels_.size(); ++i) {
    if (cells_.insert(surfels_[i].cell) == first_.size()) first_.push_back(i);
  }
  first_.push_back(surfels_.size());
  for (Surfel& surfel : surfels_) {
    if (within(surfel.cell, kNormalMargin)) find_normal(surfel);
    if (!within(surfel.cell, 0)) continue;
    ++own_;
    lonely_ += surfel.normal.isZero();
  }
}

std::span<const Surfel> Surfels::of(const Eigen::Vector3i& cell) const {
  const std::uint32_t number = cells_.find(cell);
  if (number == VoxelTable::kNone) return {};
  return std::span(surfels_).subspan(first_[number], first_[number + 1] - first_[number]);
}

void Surfels::find_normal(Surfel& surfel) {
  PlaneMoments moments;
  for_each_near(surfel.cell, surfel.offset, kNormalReach,
                [&](const Surfel& other, const Eigen::Vector3f& place) {
                  if (place.squaredNorm() > kNormalReach * kNormalReach) return;
                  if (other.towards.dot(surfel.towards) > 0) moments.add(place);
                });
  if (moments.count < kFewestAround) return;
  const Eigen::Matrix3f covariance = moments.covariance();
  const Eigen::Vector3f& sight = surfel.towards;
  const Eigen::Vector3f normal = direction_of_least_variance(
      covariance +
      kSightShare * covariance.trace() * (Eigen::Matrix3f::Identity() - sight * sight.transpose()));
  surfel.normal = normal.dot(sight) < 0 ? Eigen::Vector3f(-normal) : normal;
}

}  // namespace fovea
