#include "fovea/mapping/registration/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "fovea/core/angle.h"
#include "fovea/core/lanes.h"
#include "fovea/core/parallel.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/plane_moments.h"
#include "fovea/geometry/point_rows.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 256;

/// Computes normals of planes, toward the origin, in batches of eight.
class PlaneNormals {
 public:
  explicit PlaneNormals(std::vector<Eigen::Vector3f>& normals) : normals_(normals) {}

  /// @param point, center  index and position of the point; its normal stays zero without a plane
  void put(std::size_t point, const PlaneMoments& moments, const Eigen::Vector3f& center) {
    if (moments.count < 3) return;
    moments_.put(count_, moments);
    for (std::size_t i = 0; i < 3; ++i) center_[i][count_] = center[Eigen::Index(i)];
    point_[static_cast<std::size_t>(count_)] = point;
    if (++count_ == kLanes) finish();
  }

  void finish() {
    std::array<Lanes, 3> normal = directions_of_least_variance(moments_.covariance());
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
  MomentLanes moments_;
  std::array<Lanes, 3> center_{};
  std::array<std::size_t, kLanes> point_{};
  int count_ = 0;
};

/// Largest tilt of a normal by range noise (rad).
constexpr float kMaxTilt = 4 * static_cast<float>(kDegree);

/// Range noise s tilts the plane of n points by s / sqrt(n v), where v is the middle eigenvalue of
/// their covariance.
/// @return n v (m^2), for points near a plane
float middle_moment(const PlaneMoments& moments) {
  const Eigen::Vector3f mean = moments.sum / moments.count;
  const Eigen::Vector3f squares = moments.squares / moments.count - mean.cwiseAbs2();
  const Eigen::Vector3f products =
      moments.products / moments.count -
      Eigen::Vector3f(mean.y() * mean.z(), mean.x() * mean.z(), mean.x() * mean.y());
  // With a least eigenvalue of zero, the other two have this sum and this product.
  const float sum = squares.sum();
  const float product = squares.x() * squares.y() + squares.x() * squares.z() +
                        squares.y() * squares.z() - products.squaredNorm();
  const float difference = std::sqrt(std::max(0.0f, sum * sum - 4 * product));
  return moments.count * (sum - difference) / 2;
}

/// Moments of the points within a radius.
PlaneMoments moments_around(const Eigen::Vector3f& center, float radius, const PointRows& points,
                            const RowSurroundings& surroundings) {
  Lanes count{}, sx{}, sy{}, sz{}, sxx{}, syy{}, szz{}, syz{}, sxz{}, sxy{};
  const Lanes radius2 = all_lanes(radius * radius), one = all_lanes(1);
  const std::array<const float*, 3> row{points.coordinates(0), points.coordinates(1),
                                        points.coordinates(2)};
  for (const PointRows::Range& range : surroundings.ranges()) {
    for (std::size_t i = range.begin; i < range.end; i += kLanes) {
      const Lanes x = lanes_at(row[0] + i) - center.x(), y = lanes_at(row[1] + i) - center.y(),
                  z = lanes_at(row[2] + i) - center.z();
      // Lanes beyond the end of the range hold other points.
      const LaneMask inside = (x * x + y * y + z * z <= radius2) & first_lanes(range.end - i);
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
  const HalfLanes first = sums_of_lanes(count, sx, sy, sz),
                  second = sums_of_lanes(sxx, syy, szz, syz),
                  third = sums_of_lanes(sxz, sxy, sxz, sxy);
  return {first[0],
          {first[1], first[2], first[3]},
          {second[0], second[1], second[2]},
          {second[3], third[0], third[1]}};
}

/// Radii in spacings. Wider radii serve points that the narrower ones leave without a plane.
constexpr float kFirstRadius = 2, kRadiusRatio = 1.5f;
constexpr std::size_t kRadii = 8;
/// The first two radii serve most points and have grids of their own. The other radii serve few
/// points and share a grid with the edge of this radius.
constexpr std::size_t kSharedGrid = 3;
/// The number of points of a surface grows by 2.25 from radius to radius. With at least this share
/// of k, the mean number is k.
constexpr float kMinCountShare = 0.6f;
constexpr std::size_t kRowGrain = 64;

/// Least number of points of a plane and their least middle_moment().
struct PlaneLimits {
  float count = 0, moment = 0;
};

/// Fits normals to the points that are not done, if their neighbors within the radius determine a
/// plane.
void fit_within(std::span<const Eigen::Vector3f> points, const PointRows& sorted, float radius,
                const PlaneLimits& least, std::vector<std::uint8_t>& done,
                std::vector<Eigen::Vector3f>& normals) {
  // The small offset absorbs rounding of the quotient.
  const int reach = static_cast<int>(std::ceil(radius / sorted.edge() - 1e-4f));
  const auto open = [&](std::uint32_t first_point, std::uint32_t end) {
    const auto places = sorted.order().subspan(first_point, end - first_point);
    return std::any_of(places.begin(), places.end(), [&](std::uint32_t i) { return done[i] == 0; });
  };
  parallel_chunks(sorted.size(), kRowGrain, [&](std::size_t begin, std::size_t end) {
    RowSurroundings surroundings(sorted, reach, begin);
    PlaneNormals planes(normals);
    for (std::size_t row = begin; row < end; ++row) {
      const std::uint32_t first = sorted.rows()[row].first_cell,
                          last = sorted.rows()[row + 1].first_cell;
      const auto cells = sorted.cells();
      if (!open(cells[first].first_point, cells[last].first_point)) continue;
      surroundings.begin_row(row);
      for (std::uint32_t cell = first; cell < last; ++cell) {
        const std::uint32_t first_point = cells[cell].first_point,
                            end_point = cells[cell + 1].first_point;
        if (!open(first_point, end_point)) continue;
        surroundings.move_to(cells[cell].x);
        if (static_cast<float>(surroundings.size()) < least.count) continue;
        for (const std::uint32_t i : sorted.order().subspan(first_point, end_point - first_point)) {
          if (done[i] != 0) continue;
          const PlaneMoments moments = moments_around(points[i], radius, sorted, surroundings);
          if (moments.count < least.count || middle_moment(moments) < least.moment) continue;
          planes.put(i, moments, points[i]);
          done[i] = 1;
        }
      }
    }
    planes.finish();
  });
}

/// One normal for each point; zero for points that are not in `of`.
std::vector<Eigen::Vector3f> normals_by_radius(std::span<const Eigen::Vector3f> points,
                                               std::span<const std::uint32_t> of,
                                               const NormalOptions& options) {
  std::vector<Eigen::Vector3f> normals(points.size(), Eigen::Vector3f::Zero());
  std::vector<std::uint8_t> done(points.size(), 1);
  for (const std::uint32_t i : of) done[i] = 0;
  std::array<float, kRadii> radius;
  radius[0] = kFirstRadius * static_cast<float>(options.spacing);
  for (std::size_t i = 1; i < kRadii; ++i) radius[i] = radius[i - 1] * kRadiusRatio;
  // Build the grids in parallel, one thread each.
  const std::array<float, 3> edges{radius[0], radius[1], radius[kSharedGrid]};
  std::array<std::optional<PointRows>, edges.size()> grids;
  parallel_for(grids.size(), 1, [&](std::size_t k) { grids[k].emplace(points, edges[k]); });
  const float tilt_moment = static_cast<float>(options.range_noise) / kMaxTilt;
  const PlaneLimits least{kMinCountShare * static_cast<float>(options.neighbors),
                          tilt_moment * tilt_moment};
  for (std::size_t i = 0; i < kRadii; ++i) {
    fit_within(points, *grids[std::min(i, grids.size() - 1)], radius[i], least, done, normals);
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
                                              std::span<const std::uint32_t> of,
                                              const NormalOptions& options) {
  const std::vector<Eigen::Vector3f> by_point =
      options.spacing > 0 ? normals_by_radius(points, of, options)
                          : normals_by_tree(points, of, options.neighbors);
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(of.size());
  for (const std::uint32_t i : of) normals.push_back(by_point[i]);
  return normals;
}

std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              const NormalOptions& options) {
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  return estimate_normals(points, all, options);
}

}  // namespace fovea
