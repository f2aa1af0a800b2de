#include "fovea/exporting/mesh/implicit_surface.h"

namespace fovea {
namespace {

/// Sums over surfels.
struct Sums {
  float weight = 0, distance = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();

  void add(const Sums& other) {
    weight += other.weight;
    distance += other.distance;
    normal += other.normal;
  }
  SurfaceSide side() const { return {distance / weight, normal.normalized()}; }
};

struct CornerSums {
  Eigen::Vector3f first;  // the normal of its first surfel
  std::array<Sums, 2> side;
};

ImplicitSurface::Sides sides_of(const CornerSums& corner) {
  const auto& [front, back] = corner.side;
  ImplicitSurface::Sides sides;
  const bool opposite =
      back.weight > 0 && front.normal.dot(back.normal) <
                             ImplicitSurface::kOpposite * front.normal.norm() * back.normal.norm();
  if (opposite) {
    sides.side = {front.side(), back.side()};
    sides.count = 2;
  } else {
    Sums all = front;
    all.add(back);
    sides.side[0] = all.side();
    sides.count = 1;
  }
  return sides;
}

}  // namespace

ImplicitSurface::ImplicitSurface(const Surfels& surfels) {
  constexpr float kRadius = kReach;
  std::vector<CornerSums> sums;
  for (const Surfel& surfel : surfels.all()) {
    if (surfel.normal.isZero()) continue;
    // The corners within reach, from the one below the surfel.
    const Eigen::Vector3i base = surfel.cell.unaryExpr([](int c) { return c >> 1; });
    const Eigen::Vector3f from_base =
        (surfel.cell - kVoxelCells * base).cast<float>() + surfel.offset;
    Eigen::Vector3i step;
    for (step.z() = -1; step.z() <= 2; ++step.z()) {
      for (step.y() = -1; step.y() <= 2; ++step.y()) {
        for (step.x() = -1; step.x() <= 2; ++step.x()) {
          const Eigen::Vector3i corner = base + step;
          if ((corner.array() < -1).any() || (corner.array() > kBlockVoxels).any()) continue;
          const Eigen::Vector3f away = (kVoxelCells * step).cast<float>() - from_base;
          const float weight = bump(away.squaredNorm(), kRadius);
          if (!(weight > 0)) continue;
          const std::uint32_t number = corners_.insert(corner);
          if (number == sums.size()) sums.push_back({surfel.normal, {}});
          CornerSums& of_corner = sums[number];
          of_corner.side[surfel.normal.dot(of_corner.first) < 0 ? 1 : 0].add(
              {weight, weight * surfel.normal.dot(away) / kVoxelCells, weight * surfel.normal});
        }
      }
    }
  }
  static_assert(kVoxelCells == 2 && kReach <= 3, "the steps above");
  sides_.reserve(sums.size());
  for (const CornerSums& corner : sums) sides_.push_back(sides_of(corner));
}

}  // namespace fovea
