#include "fovea/exporting/mesh/seen_points.h"

#include <Eigen/Geometry>
#include <cmath>

#include "fovea/exporting/mesh/mesh_lattice.h"
#include "fovea/geometry/voxel_table.h"

namespace fovea {
namespace {

/// Sums over the points of a cell that were seen from one side.
struct Side {
  float count = 0, colored = 0;
  Eigen::Vector3f first;  // its first point's direction
  Eigen::Vector3f position = Eigen::Vector3f::Zero(), towards = Eigen::Vector3f::Zero(),
                  color = Eigen::Vector3f::Zero();

  void add(const SeenPoint& point) {
    if (count == 0) first = direction_of(point);
    count += 1;
    position += position_of(point);
    towards += direction_of(point);
    if (point.colored == 0) return;
    colored += 1;
    color += to_float(point.color);
  }
  SeenPoint mean() const {
    SeenPoint point = seen_point(position / count, towards);
    point.colored = colored > 0;
    if (colored > 0) point.color = to_rgb(color / colored);
    return point;
  }
};

}  // namespace

Eigen::Vector3f position_of(const SeenPoint& point) {
  return {point.position[0], point.position[1], point.position[2]};
}

Eigen::Vector3f direction_of(const SeenPoint& point) {
  return Eigen::Vector3f(point.towards[0], point.towards[1], point.towards[2]).normalized();
}

SeenPoint seen_point(const Eigen::Vector3f& position, const Eigen::Vector3f& towards) {
  SeenPoint point;
  point.position = {position.x(), position.y(), position.z()};
  // Whoever was at the point itself, or all around it, has seen it from above.
  const float length = towards.norm();
  const Eigen::Vector3f unit = length > 0 && std::isfinite(length)
                                   ? Eigen::Vector3f(towards / length)
                                   : Eigen::Vector3f::UnitZ();
  for (std::size_t i = 0; i < 3; ++i) {
    point.towards[i] = static_cast<std::int8_t>(std::lround(127 * unit[Eigen::Index(i)]));
  }
  return point;
}

Eigen::Array3i cell_in_block(const SeenPoint& point, double cell) {
  const Eigen::Array3f place = position_of(point).array() / static_cast<float>(cell);
  return place.floor().cast<int>().max(0).min(kBlockCells - 1);
}

std::vector<SeenPoint> thinned(const std::vector<SeenPoint>& points, double cell) {
  VoxelTable cells(1.f);
  std::vector<std::array<Side, 2>> sides;  // by the cell's number
  for (const SeenPoint& point : points) {
    const std::uint32_t number = cells.insert(cell_in_block(point, cell).matrix());
    if (number == sides.size()) sides.emplace_back();
    Side& front = sides[number][0];
    const bool behind = front.count > 0 && direction_of(point).dot(front.first) < 0;
    sides[number][behind ? 1 : 0].add(point);
  }
  std::vector<SeenPoint> means;
  means.reserve(sides.size());
  for (const std::array<Side, 2>& of_cell : sides) {
    for (const Side& side : of_cell) {
      if (side.count > 0) means.push_back(side.mean());
    }
  }
  return means;
}

}  // namespace fovea
