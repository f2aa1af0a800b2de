#include "fovea/mapping/registration/normals.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "fovea/base/lanes.h"
#include "fovea/base/parallel.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/plane_moments.h"
#include "fovea/geometry/voxel_members.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 256;

/// Normals of planes, towards the origin; eight are worked out at a time.
class PlaneNormals {
 public:
  explicit PlaneNormals(std::vector<Eigen::Vector3f>& normals) : normals_(normals) {}

  /// @param point, center  whose normal it is; zero where there is no plane
  void put(std::size_t point, const PlaneMoments& moments, const Eigen::Vector3f& center) {
    if (moments.count < 3) return;
    covariance_.put(count_, moments.covariance());
    for (std::size_t i = 0; i < 3; ++i) center_[i][count_] = center[Eigen::Index(i)];
    point_[static_cast<std::size_t>(count_)] = point;
    if (++count_ == kLanes) finish();
  }

  void finish() {
    std::array<Lanes, 3> normal = directions_of_least_variance(covariance_);
    const Lanes away = normal[0] * center_[0] + normal[1] * center_[1] + normal[2] * center_[2];
    for (Lanes& coordinate : normal) coordinate = away > 0 ? -coordinate : coordinate;
    for (int lane = 0; lane < count_; ++lane) {
      normals_[point_[static_cast<std::size_t>(lane)]] = {normal[0][lane], normal[1][lane],
                                                          normal[2][lane]};
    }
    count_ = 0;
  }

 private:
  std::vector<Eigen::Vector3f>& normals_;
  SymmetricLanes covariance_;
  std::array<Lanes, 3> center_{};
  std::array<std::size_t, kLanes> point_{};
  int count_ = 0;
};

/// Points by the cells of a grid: no point within an edge of one is missed in the cells around its
/// own.
struct PointCells {
  VoxelTable table;
  VoxelMembers members;
  /// Of the members, a row for each coordinate, and some more for whole lanes to be read.
  std::array<std::vector<float>, 3> row;

  static PointCells of(std::span<const Eigen::Vector3f> points, float edge) {
    VoxelTable table(edge);
    std::vector<std::uint32_t> cell(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      cell[i] = table.insert(table.voxel_of(points[i]));
    VoxelMembers members(cell, table.size());
    std::array<std::vector<float>, 3> rows;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows[axis].reserve(points.size() + kLanes);
      for (const std::uint32_t i : members.all()) {
        rows[axis].push_back(points[i][Eigen::Index(axis)]);
      }
      rows[axis].resize(points.size() + kLanes);
    }
    return {std::move(table), std::move(members), std::move(rows)};
  }
};

/// Points of some cells.
class Surroundings {
 public:
  explicit Surroundings(const PointCells& cells) : cells_(cells) {}
  void clear() { count_ = size_ = 0; }
  std::size_t size() const { return size_; }

  /// At most 27 cells.
  void add(std::uint32_t cell) {
    const std::size_t points = cells_.members.of(cell).size();
    range_[count_++] = {cells_.members.first(cell), points};
    size_ += points;
  }

  /// Of those within a radius.
  PlaneMoments moments(const Eigen::Vector3f& center, float radius) const {
    Lanes count{}, sx{}, sy{}, sz{}, sxx{}, syy{}, szz{}, syz{}, sxz{}, sxy{};
    const Lanes radius2 = all_lanes(radius * radius), one = all_lanes(1);
    for (const Range& range : std::span(range_).first(count_)) {
      for (std::size_t i = 0; i < range.count; i += kLanes) {
        const std::size_t place = range.first + i;
        const Lanes x = lanes_at(cells_.row[0].data() + place) - center.x(),
                    y = lanes_at(cells_.row[1].data() + place) - center.y(),
                    z = lanes_at(cells_.row[2].data() + place) - center.z();
        // What follows the last of a cell is another's.
        const LaneMask inside = (x * x + y * y + z * z <= radius2) & first_lanes(range.count - i);
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
    }
    return {sum_of_lanes(count),
            {sum_of_lanes(sx), sum_of_lanes(sy), sum_of_lanes(sz)},
            {sum_of_lanes(sxx), sum_of_lanes(syy), sum_of_lanes(szz)},
            {sum_of_lanes(syz), sum_of_lanes(sxz), sum_of_lanes(sxy)}};
  }

 private:
  struct Range {
    std::size_t first, count;  // in the rows of the cells
  };
  const PointCells& cells_;
  std::array<Range, 27> range_;
  std::size_t count_ = 0, size_ = 0;  // of ranges, and of points in them
};

/// Radii over the points' spacing: where points are far apart, wider ones are tried.
constexpr float kFirstRadius = 2, kWider = 1.5f;
constexpr std::size_t kRadii = 8;
/// The first radii serve most points and have cells of their own; of those after them, which are
/// for the few that lie far apart, two share a grid.
constexpr std::size_t kAlone = 2;
/// From radius to radius a surface's points become 2.25 times as many: of at least this share of k,
/// they are k in the mean.
constexpr float kFewest = 0.6f;
constexpr std::size_t kCellGrain = 64;

/// Normals of the points not yet done that have neighbours enough within the radius.
void look_around(std::span<const Eigen::Vector3f> points, const PointCells& cells, float radius,
                 float enough, std::vector<std::uint8_t>& done,
                 std::vector<Eigen::Vector3f>& normals) {
  const VoxelTable& table = cells.table;
  const VoxelMembers& members = cells.members;
  const auto gather = [&](std::uint32_t cell, Surroundings& surroundings) {
    table.for_each_around(table.voxel(cell), [&](std::uint32_t near) { surroundings.add(near); });
  };
  parallel_chunks(table.size(), kCellGrain, [&](std::size_t begin, std::size_t end) {
    Surroundings surroundings(cells);
    PlaneNormals planes(normals);
    for (auto cell = static_cast<std::uint32_t>(begin); cell < end; ++cell) {
      surroundings.clear();
      for (const std::uint32_t i : members.of(cell)) {
        if (done[i] != 0) continue;
        if (surroundings.size() == 0) gather(cell, surroundings);
        if (static_cast<float>(surroundings.size()) < enough) break;
        const PlaneMoments moments = surroundings.moments(points[i], radius);
        if (moments.count < enough) continue;
        planes.put(i, moments, points[i]);
        done[i] = 1;
      }
    }
    planes.finish();
  });
}

/// By point; of those not asked for they are zero.
std::vector<Eigen::Vector3f> normals_by_radius(std::span<const Eigen::Vector3f> points,
                                               std::span<const std::uint32_t> of, int neighbors,
                                               double spacing) {
  std::vector<Eigen::Vector3f> normals(points.size(), Eigen::Vector3f::Zero());
  std::vector<std::uint8_t> done(points.size(), 1);
  for (const std::uint32_t i : of) done[i] = 0;
  std::array<float, kRadii> radius;
  std::array<std::size_t, kRadii> grid;
  std::vector<float> edges;
  for (std::size_t i = 0; i < kRadii; ++i) {
    radius[i] = i == 0 ? kFirstRadius * static_cast<float>(spacing) : radius[i - 1] * kWider;
    if (edges.empty() || radius[i] > edges.back()) {
      edges.push_back(i < kAlone ? radius[i] : radius[i] * kWider);
    }
    grid[i] = edges.size() - 1;
  }
  // All of them first: each is one thread's work.
  std::vector<std::optional<PointCells>> grids(edges.size());
  parallel_for(grids.size(), 1,
               [&](std::size_t k) { grids[k] = PointCells::of(points, edges[k]); });
  for (std::size_t i = 0; i < kRadii; ++i) {
    look_around(points, *grids[grid[i]], radius[i], kFewest * static_cast<float>(neighbors), done,
                normals);
  }
  return normals;
}

std::vector<Eigen::Vector3f> normals_by_tree(std::span<const Eigen::Vector3f> points,
                                             std::span<const std::uint32_t> of, int neighbors) {
  const KdTree tree(points);
  std::vector<Eigen::Vector3f> normals(points.size(), Eigen::Vector3f::Zero());
  parallel_chunks(of.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> found;
    PlaneNormals planes(normals);
    for (const std::uint32_t i : of.subspan(begin, end - begin)) {
      tree.nearest_k(points[i], static_cast<std::size_t>(neighbors), found);
      PlaneMoments moments;
      for (const Neighbor& neighbor : found) moments.add(points[neighbor.index] - points[i]);
      planes.put(i, moments, points[i]);
    }
    planes.finish();
  });
  return normals;
}

}  // namespace

std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              std::span<const std::uint32_t> of, int neighbors,
                                              double spacing) {
  const std::vector<Eigen::Vector3f> by_point =
      spacing > 0 ? normals_by_radius(points, of, neighbors, spacing)
                  : normals_by_tree(points, of, neighbors);
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(of.size());
  for (const std::uint32_t i : of) normals.push_back(by_point[i]);
  return normals;
}

std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              int neighbors, double spacing) {
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  return estimate_normals(points, all, neighbors, spacing);
}

}  // namespace fovea
