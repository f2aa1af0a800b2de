#include "fovea/mapping/scan_projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr double kCell = 8;  // pixels
constexpr std::size_t kGrain = 8192;
constexpr double kMargin = 8;  // points outside the image may hide others and form edges

}  // namespace

int ScanProjection::column_of(double u) const {
  return std::clamp(static_cast<int>((u + kMargin) / kCell), 0, columns_ - 1);
}
int ScanProjection::row_of(double v) const {
  return std::clamp(static_cast<int>((v + kMargin) / kCell), 0, rows_ - 1);
}

ScanProjection::ScanProjection(const PointCloud& scan_lidar, const Camera& camera)
    : columns_(static_cast<int>((camera.width + 2 * kMargin) / kCell) + 1),
      rows_(static_cast<int>((camera.height + 2 * kMargin) / kCell) + 1),
      hiding_radius_(camera.fx * std::tan(kHidingDegrees * std::numbers::pi / 180)),
      focal_(camera.fx) {
  std::vector<std::vector<Point>> chunks((scan_lidar.size() + kGrain - 1) / kGrain);
  parallel_chunks(scan_lidar.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d p_cam = camera.T_cam_lidar * scan_lidar.position[i].cast<double>();
      const std::optional<Eigen::Vector2d> pixel = camera.project(p_cam);
      if (!pixel || pixel->x() < -kMargin || pixel->x() > camera.width + kMargin ||
          pixel->y() < -kMargin || pixel->y() > camera.height + kMargin) {
        continue;
      }
      chunks[begin / kGrain].push_back({static_cast<float>(pixel->x()),
                                        static_cast<float>(pixel->y()),
                                        static_cast<float>(p_cam.norm()), scan_lidar.sensor_at(i)});
    }
  });
  std::vector<Point> seen;
  for (const std::vector<Point>& chunk : chunks) {
    seen.insert(seen.end(), chunk.begin(), chunk.end());
  }
  const auto cell_of = [&](const Point& p) {
    return static_cast<std::size_t>(row_of(p.v)) * columns_ + column_of(p.u);
  };
  first_.assign(static_cast<std::size_t>(rows_) * columns_ + 1, 0);
  for (const Point& p : seen) ++first_[cell_of(p) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  points_.resize(seen.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Point& p : seen) points_[next[cell_of(p)]++] = p;
}

template <class Test>
bool ScanProjection::any_within(const Eigen::Vector2d& pixel, double radius, Test&& test) const {
  const int right = column_of(pixel.x() + radius), bottom = row_of(pixel.y() + radius);
  for (int row = row_of(pixel.y() - radius); row <= bottom; ++row) {
    for (int column = column_of(pixel.x() - radius); column <= right; ++column) {
      const std::size_t cell = static_cast<std::size_t>(row) * columns_ + column;
      for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
        const double du = points_[k].u - pixel.x(), dv = points_[k].v - pixel.y();
        const double pixels2 = du * du + dv * dv;
        if (pixels2 <= radius * radius && test(points_[k], pixels2)) return true;
      }
    }
  }
  return false;
}

bool ScanProjection::hidden(const Eigen::Vector2d& pixel, double distance,
                            std::uint16_t sensor) const {
  return any_within(pixel, hiding_radius_, [&](const Point& other, double pixels2) {
    const double nearer = other.distance;
    if (!(distance - nearer > std::max(kHidingStep, kHidingShare * nearer))) return false;
    if (other.sensor == sensor) return true;
    const double radius = focal_ * kHidingDistance / nearer;  // pixels
    return pixels2 <= radius * radius;
  });
}

bool ScanProjection::near_edge(const Eigen::Vector2d& pixel, double distance) const {
  return any_within(pixel, kEdgePixels, [&](const Point& point, double) {
    const double other = point.distance;
    return std::abs(distance - other) > std::max(kEdgeStep, kEdgeShare * std::min(distance, other));
  });
}

std::size_t drop_hidden(PointCloud& points_cam, const PointCloud& scan_lidar,
                        const Camera& camera) {
  constexpr std::size_t kPoints = 1024;
  const ScanProjection projection(scan_lidar, camera);
  std::vector<std::uint8_t> is_hidden(points_cam.size());
  parallel_for(is_hidden.size(), kPoints, [&](std::size_t i) {
    const Eigen::Vector3d p = points_cam.position[i].cast<double>();
    is_hidden[i] = projection.hidden(camera.project(p).value(), p.norm(), points_cam.sensor_at(i));
  });
  return points_cam.drop(is_hidden);
}

}  // namespace fovea
