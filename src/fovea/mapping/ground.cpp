#include "fovea/ground.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "fovea/core/random.h"

namespace fovea {
namespace {

/// Tolerance of the height of the plane below the sensor (m). It excludes roofs, embankments and
/// retaining walls.
constexpr float kMaxHeightError = 0.5f;
/// Beyond this range (m) the road may leave the plane.
constexpr float kMaxGroundRange = 40.0f;
constexpr std::size_t kMaxSamples = 4000;
constexpr std::size_t kMinSupport = 50;

/// z = normal . p + offset = 0, normal upwards.
struct Plane {
  Eigen::Vector3f normal;
  float offset;
  float height(const Eigen::Vector3f& p) const { return normal.dot(p) + offset; }
};

bool is_plausible(const Plane& plane, const GroundOptions& options) {
  const auto max_tilt = options.ransac_max_tilt * std::numbers::pi / 180;
  return plane.normal.z() >= static_cast<float>(std::cos(max_tilt)) &&
         std::abs(plane.offset / plane.normal.z() - static_cast<float>(options.sensor_height)) <=
             kMaxHeightError;
}

/// Points that may be on a plausible plane: a double cone about the nominal ground.
std::vector<Eigen::Vector3f> candidates(std::span<const Eigen::Vector3f> points,
                                        const GroundOptions& options) {
  const float slope =
      static_cast<float>(std::tan(options.ransac_max_tilt * std::numbers::pi / 180));
  std::vector<Eigen::Vector3f> found;
  for (const Eigen::Vector3f& p : points) {
    const float range = p.head<2>().norm();
    const float height = p.z() + static_cast<float>(options.sensor_height);
    if (range < kMaxGroundRange && std::abs(height) < kMaxHeightError + slope * range) {
      found.push_back(p);
    }
  }
  if (found.size() > kMaxSamples) {  // thinned evenly
    const std::size_t stride = (found.size() + kMaxSamples - 1) / kMaxSamples;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.size(); i += stride) found[kept++] = found[i];
    found.resize(kept);
  }
  return found;
}

std::optional<Plane> plane_through(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                   const Eigen::Vector3f& c) {
  Eigen::Vector3f normal = (b - a).cross(c - a);
  const float length = normal.norm();
  if (!(length > 1e-3f)) return std::nullopt;
  normal *= (normal.z() < 0 ? -1 : 1) / length;
  return Plane{normal, -normal.dot(a)};
}

/// MSAC (Torr, Zisserman 2000): sum of squared heights, truncated at the tolerance.
float cost(const Plane& plane, std::span<const Eigen::Vector3f> samples, float tolerance) {
  float sum = 0;
  for (const Eigen::Vector3f& p : samples) {
    const float height = plane.height(p);
    sum += std::min(height * height, tolerance * tolerance);
  }
  return sum;
}

/// Least-squares plane of the samples within the tolerance; empty if they are too few.
std::optional<Plane> refit(const Plane& plane, std::span<const Eigen::Vector3f> samples,
                           float tolerance) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  std::size_t count = 0;
  for (const Eigen::Vector3f& p : samples) {
    if (std::abs(plane.height(p)) > tolerance) continue;
    const Eigen::Vector3d d = p.cast<double>();
    sum += d;
    squares += d * d.transpose();
    ++count;
  }
  if (count < kMinSupport) return std::nullopt;
  const Eigen::Vector3d mean = sum / static_cast<double>(count);
  const Eigen::Matrix3d covariance = squares / static_cast<double>(count) - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Eigen::Vector3d normal = solver.eigenvectors().col(0);
  if (normal.z() < 0) normal = -normal;
  return Plane{normal.cast<float>(), static_cast<float>(-normal.dot(mean))};
}

std::optional<Plane> find_ground_plane(std::span<const Eigen::Vector3f> points,
                                       const GroundOptions& options) {
  const std::vector<Eigen::Vector3f> samples = candidates(points, options);
  if (samples.size() < kMinSupport) return std::nullopt;
  // Half the tolerance: the plane should fit the road alone, not the road and the curb.
  const float tolerance = static_cast<float>(options.tolerance) / 2;
  Random random(options.seed);
  const auto draw = [&]() -> const Eigen::Vector3f& {
    return samples[random.below(samples.size())];
  };

  std::optional<Plane> best;
  float best_cost = std::numeric_limits<float>::infinity();
  for (int i = 0; i < options.ransac_iterations; ++i) {
    // One statement each: the evaluation order of arguments is unspecified.
    const Eigen::Vector3f& a = draw();
    const Eigen::Vector3f& b = draw();
    const Eigen::Vector3f& c = draw();
    const std::optional<Plane> plane = plane_through(a, b, c);
    if (!plane || !is_plausible(*plane, options)) continue;
    const float plane_cost = cost(*plane, samples, tolerance);
    if (plane_cost < best_cost) {
      best_cost = plane_cost;
      best = plane;
    }
  }
  for (int i = 0; best && i < 2; ++i) best = refit(*best, samples, tolerance);
  if (best && !is_plausible(*best, options)) return std::nullopt;
  return best;
}

}  // namespace

std::optional<double> sensor_height(std::span<const Eigen::Vector3f> points_lidar) {
  constexpr double kStep = 0.6;         // m, between trial heights; each covers 0.5 m
  constexpr float kLeastHeight = 0.4f;  // m
  constexpr double kLeastShare = 0.05;  // of all points
  GroundOptions options{
      .method = GroundMethod::kRansac, .ransac_iterations = 50, .ransac_max_tilt = 25};
  std::optional<double> best;
  double most = kLeastShare * static_cast<double>(points_lidar.size());
  for (options.sensor_height = kStep; options.sensor_height < 4.5; options.sensor_height += kStep) {
    const auto plane = find_ground_plane(points_lidar, options);
    if (!plane || plane->offset < kLeastHeight) continue;
    const auto on_plane =
        std::count_if(points_lidar.begin(), points_lidar.end(), [&](const Eigen::Vector3f& p) {
          return p.head<2>().norm() < kMaxGroundRange &&
                 std::abs(plane->height(p)) < static_cast<float>(options.tolerance) / 2;
        });
    if (static_cast<double>(on_plane) <= most) continue;
    most = static_cast<double>(on_plane);
    best = plane->offset;
  }
  return best;
}

std::vector<std::uint8_t> segment_ground(std::span<const Eigen::Vector3f> points_lidar,
                                         const GroundOptions& options) {
  Plane plane{Eigen::Vector3f::UnitZ(), static_cast<float>(options.sensor_height)};
  if (options.method == GroundMethod::kRansac) {
    plane = find_ground_plane(points_lidar, options).value_or(plane);
  }
  const float tolerance = static_cast<float>(options.tolerance);
  std::vector<std::uint8_t> mask(points_lidar.size());
  for (std::size_t i = 0; i < points_lidar.size(); ++i) {
    mask[i] = plane.height(points_lidar[i]) < tolerance ? 1 : 0;
  }
  return mask;
}

}  // namespace fovea
