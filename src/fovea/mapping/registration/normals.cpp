#include "fovea/mapping/registration/normals.h"

#include <algorithm>
#include <array>

#include "fovea/base/lanes.h"
#include "fovea/base/parallel.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/plane_moments.h"
#include "fovea/geometry/voxel_members.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 256;

/// Direction of least variance, towards the origin; zero where there is no plane.
/// @param center  of the moments
Eigen::Vector3f plane_normal(const PlaneMoments& moments, const Eigen::Vector3f& center) {
  if (moments.count < 3) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f normal = direction_of_least_variance(moments.covariance());
  return normal.dot(center) > 0 ? Eigen::Vector3f(-normal) : normal;
}

/// Points by the cells of a grid.
struct PointCells {
  VoxelTable table;
  VoxelMembers members;

  static PointCells of(std::span<const Eigen::Vector3f> points, float edge) {
    VoxelTable table(edge);
    std::vector<std::uint32_t> cell(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      cell[i] = table.insert(table.voxel_of(points[i]));
    VoxelMembers members(cell, table.size());
    return {std::move(table), std::move(members)};
  }
};

/// Points of some cells.
class Surroundings {
 public:
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }

  void add(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> members) {
    blocks_.resize(std::max(blocks_.size(), (size_ + members.size()) / kLanes + 1));
    for (const std::uint32_t member : members) {
      Block& block = blocks_[size_ / kLanes];
      const std::size_t lane = size_ % kLanes;
      if (lane == 0) block.fill(all_lanes(kNowhere));
      for (std::size_t i = 0; i < 3; ++i) block[i][lane] = points[member][Eigen::Index(i)];
      ++size_;
    }
  }

  /// Of those within a radius.
  PlaneMoments moments(const Eigen::Vector3f& center, float radius) const {
    Lanes count{}, sx{}, sy{}, sz{}, sxx{}, syy{}, szz{}, syz{}, sxz{}, sxy{};
    const Lanes radius2 = all_lanes(radius * radius), one = all_lanes(1);
    const std::size_t blocks = (size_ + kLanes - 1) / kLanes;
    for (std::size_t k = 0; k < blocks; ++k) {
      const Lanes x = blocks_[k][0] - center.x(), y = blocks_[k][1] - center.y(),
                  z = blocks_[k][2] - center.z();
      const LaneMask inside = x * x + y * y + z * z <= radius2;
      const Lanes in_x = where(inside, x), in_y = where(inside, y), in_z = where(inside, z);
      count += where(inside, one);
      sx += in_x;
      sy += in_y;
      sz += in_z;
      sxx += in_x * x;
      syy += in_y * y;
      szz += in_z * z;
      syz += in_y * z;
      sxz += in_x * z;
      sxy += in_x * y;
    }
    return {sum_of_lanes(count),
            {sum_of_lanes(sx), sum_of_lanes(sy), sum_of_lanes(sz)},
            {sum_of_lanes(sxx), sum_of_lanes(syy), sum_of_lanes(szz)},
            {sum_of_lanes(syz), sum_of_lanes(sxz), sum_of_lanes(sxy)}};
  }

 private:
  static constexpr float kNowhere = 1e9f;  // m: outside of every radius
  using Block = std::array<Lanes, 3>;
  std::vector<Block> blocks_;
  std::size_t size_ = 0;
};

/// Radii over the points' spacing: where points are far apart, wider ones are tried.
constexpr float kFirstRadius = 2, kWider = 1.5f;
constexpr int kRadii = 8;
/// From radius to radius a surface's points become 2.25 times as many: of at least this share of k,
/// they are k in the mean.
constexpr float kFewest = 0.6f;
constexpr std::size_t kCellGrain = 64;

/// Normals of the points not yet done that have neighbours enough within the radius.
void look_around(std::span<const Eigen::Vector3f> points, float radius, float enough,
                 std::vector<std::uint8_t>& done, std::vector<Eigen::Vector3f>& normals) {
  const PointCells cells = PointCells::of(points, radius);
  const VoxelTable& table = cells.table;
  const VoxelMembers& members = cells.members;
  const auto gather = [&](std::uint32_t cell, Surroundings& surroundings) {
    // Cells as wide as the radius: no point within it is missed.
    for (const VoxelTable::Voxel& near : VoxelTable::block_around(table.voxel(cell))) {
      const std::uint32_t id = table.find(near);
      if (id != VoxelTable::kNone) surroundings.add(points, members.of(id));
    }
  };
  parallel_chunks(table.size(), kCellGrain, [&](std::size_t begin, std::size_t end) {
    Surroundings surroundings;
    for (auto cell = static_cast<std::uint32_t>(begin); cell < end; ++cell) {
      surroundings.clear();
      for (const std::uint32_t i : members.of(cell)) {
        if (done[i] != 0) continue;
        if (surroundings.size() == 0) gather(cell, surroundings);
        if (static_cast<float>(surroundings.size()) < enough) break;
        const PlaneMoments moments = surroundings.moments(points[i], radius);
        if (moments.count < enough) continue;
        normals[i] = plane_normal(moments, points[i]);
        done[i] = 1;
      }
    }
  });
}

std::vector<Eigen::Vector3f> normals_by_radius(std::span<const Eigen::Vector3f> points,
                                               int neighbors, double spacing) {
  std::vector<Eigen::Vector3f> normals(points.size(), Eigen::Vector3f::Zero());
  std::vector<std::uint8_t> done(points.size(), 0);
  float radius = kFirstRadius * static_cast<float>(spacing);
  for (int i = 0; i < kRadii; ++i, radius *= kWider) {
    look_around(points, radius, kFewest * static_cast<float>(neighbors), done, normals);
  }
  return normals;
}

std::vector<Eigen::Vector3f> normals_by_tree(std::span<const Eigen::Vector3f> points,
                                             int neighbors) {
  const KdTree tree(points);
  std::vector<Eigen::Vector3f> normals(points.size());
  parallel_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest_k(points[i], static_cast<std::size_t>(neighbors), found);
      PlaneMoments moments;
      for (const Neighbor& neighbor : found) moments.add(points[neighbor.index] - points[i]);
      normals[i] = plane_normal(moments, points[i]);
    }
  });
  return normals;
}

}  // namespace

std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              int neighbors, double spacing) {
  return spacing > 0 ? normals_by_radius(points, neighbors, spacing)
                     : normals_by_tree(points, neighbors);
}

}  // namespace fovea
