#include "fovea/mapping/calibration/lidar_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "fovea/core/angle.h"
#include "fovea/core/median.h"

namespace fovea {
namespace {

// Beams further apart do not locate an edge well enough.
constexpr float kMaxRingStep = 0.3f * float(kDegree), kMinElevationStep = 0.2f * float(kDegree),
                kMaxElevationStep = 0.75f * float(kDegree);
// Points this near in azimuth are above each other: the width of a firing.
constexpr float kColumn = 0.2f * float(kDegree);
// Minimum jump (m), and as a share of the near range, in a ring and between rings. The spacing of
// rings on the ground grows with the square of the range: r^2 * 0.0058 / 1.73 m, 13 % at 40 m.
constexpr float kMinJump = 0.5f, kRelativeJump = 0.1f, kRelativeJumpAbove = 0.2f;

// Minimum jump as a share of the range at which a plane would continue.
constexpr float kPlaneTolerance = 0.2f;
constexpr float kHdl64Spacing = 0.42f * float(kDegree);

struct Beam {
  Eigen::Vector3f direction;
  float range = 0;
  float time = 0;
};

Beam beam_of(const Eigen::Vector3f& p, float time) {
  const float range = p.norm();
  return {p / std::max(range, 1e-6f), range, time};
}

void add_if_edge(const Beam& a, const Beam& b, float max_step, float relative_jump, float max_range,
                 bool between_rings, LidarEdges& edges) {
  const Beam &near = a.range < b.range ? a : b, &far = a.range < b.range ? b : a;
  if (near.range > max_range || near.range < 1) return;
  if (far.range - near.range < std::max(kMinJump, relative_jump * near.range)) return;
  if ((near.direction - far.direction).norm() > max_step) return;
  edges.inside.position.emplace_back(near.direction * near.range);
  edges.outside.position.emplace_back(far.direction * near.range);
  edges.inside.time.push_back(near.time);
  edges.outside.time.push_back(far.time);
  edges.between_rings.push_back(between_rings ? 1 : 0);
}

/// The points of a scan, ring after ring where it numbers the rings.
std::vector<std::uint32_t> order_by_rings(const PointCloud& scan_lidar) {
  std::vector<std::uint32_t> order(scan_lidar.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!scan_lidar.ring.empty()) {
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return scan_lidar.ring[a] < scan_lidar.ring[b];
    });
  }
  return order;
}

/// Beams in and near the view, ring after ring.
std::vector<Beam> beams_in_view(const PointCloud& scan_lidar, const Camera& camera) {
  const Eigen::Matrix3f R = camera.T_cam_lidar.linear().cast<float>();
  const Eigen::Vector3f t = camera.T_cam_lidar.translation().cast<float>();
  // Twice the view, since the correction moves edges.
  const float right = static_cast<float>(camera.width / camera.fx),
              down = static_cast<float>(camera.height / camera.fy);
  std::vector<Beam> beams;
  for (const std::uint32_t i : order_by_rings(scan_lidar)) {
    const Eigen::Vector3f& p = scan_lidar.position[i];
    const Eigen::Vector3f p_cam = R * p + t;
    if (p_cam.z() < 1 || std::abs(p_cam.x()) > right * p_cam.z() ||
        std::abs(p_cam.y()) > down * p_cam.z()) {
      continue;
    }
    beams.push_back(beam_of(p, scan_lidar.time.empty() ? 0 : scan_lidar.time[i]));
  }
  return beams;
}

void add_edges_along_rings(const std::vector<Beam>& beams, float max_range, LidarEdges& edges) {
  for (std::size_t i = 1; i < beams.size(); ++i) {
    add_if_edge(beams[i - 1], beams[i], kMaxRingStep, kRelativeJump, max_range, false, edges);
  }
}

/// Whether the far beam of two neighbors in a column, k - 1 and k, may be on a plane with the near
/// beam. The next ring on the near beam's other side defines the plane. The ground is such a plane
/// at any ring spacing and sensor height. Inverse ranges of a plane are linear in the angle.
bool continues_a_plane(const std::vector<Beam>& beams, const std::vector<std::uint32_t>& column,
                       std::size_t k) {
  const bool near_is_below = beams[column[k]].range < beams[column[k - 1]].range;
  const Beam &near = beams[column[near_is_below ? k : k - 1]],
             &far = beams[column[near_is_below ? k - 1 : k]];
  const auto angle = [](const Beam& a, const Beam& b) {
    return std::abs(a.direction.z() - b.direction.z());
  };
  const Beam* before = nullptr;
  const auto take_if_other_ring = [&](std::size_t i) {
    if (angle(beams[column[i]], near) >= kMinElevationStep) before = &beams[column[i]];
  };
  if (near_is_below) {
    for (std::size_t i = k + 1; i < column.size() && before == nullptr; ++i) take_if_other_ring(i);
  } else {
    for (std::size_t i = k - 1; i > 0 && before == nullptr; --i) take_if_other_ring(i - 1);
  }
  if (before == nullptr) return false;
  const float inverse = 1 / near.range + (1 / near.range - 1 / before->range) * angle(near, far) /
                                             angle(*before, near);
  return far.range * inverse < 1 + kPlaneTolerance;
}

void add_edges_between_rings(const std::vector<Beam>& beams, float max_range, LidarEdges& edges) {
  const auto columns = static_cast<std::size_t>(std::ceil(2 * std::numbers::pi_v<float> / kColumn));
  std::vector<std::vector<std::uint32_t>> by_column(columns);
  std::vector<float> steps;  // between rings
  for (std::uint32_t i = 0; i < beams.size(); ++i) {
    const float azimuth = std::atan2(beams[i].direction.y(), beams[i].direction.x());
    const auto column = static_cast<std::size_t>((azimuth + std::numbers::pi_v<float>) / kColumn);
    by_column[std::min(column, columns - 1)].push_back(i);
  }
  for (std::vector<std::uint32_t>& above : by_column) {
    const auto is_above = [&](std::uint32_t a, std::uint32_t b) {
      return beams[a].direction.z() > beams[b].direction.z();
    };
    // Most scans list rings from top to bottom.
    if (!std::is_sorted(above.begin(), above.end(), is_above)) {
      std::stable_sort(above.begin(), above.end(), is_above);
    }
    for (std::size_t k = 1; k < above.size(); ++k) {
      const Beam &a = beams[above[k - 1]], &b = beams[above[k]];
      const float step = a.direction.z() - b.direction.z();
      // Two firings of one ring may share a column.
      if (step < kMinElevationStep) continue;
      steps.push_back(step);
      if (continues_a_plane(beams, above, k)) continue;
      const float jump = kRelativeJumpAbove * std::max(1.0f, step / kHdl64Spacing);
      add_if_edge(a, b, kMaxElevationStep, jump, max_range, true, edges);
    }
  }
  if (!steps.empty()) edges.ring_spacing = double(median_of(std::move(steps)));
}

}  // namespace

LidarEdges find_lidar_edges(const PointCloud& scan_lidar, const Camera& camera, double max_range) {
  LidarEdges edges;
  const std::vector<Beam> beams = beams_in_view(scan_lidar, camera);
  add_edges_along_rings(beams, static_cast<float>(max_range), edges);
  add_edges_between_rings(beams, static_cast<float>(max_range), edges);
  if (scan_lidar.time.empty()) {
    edges.inside.time.clear();
    edges.outside.time.clear();
  }
  return edges;
}

}  // namespace fovea
