#include "fovea/evaluation/scan_matching.h"

#include <optional>

#include "fovea/core/parallel.h"
#include "fovea/evaluation/evaluated_set.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/ground.h"

namespace fovea {
namespace {

constexpr float kMaxDistance = 1.0f;  // m: farther neighbours are not pairs

/// A frame's matched points; empty if it cannot be read.
std::vector<Eigen::Vector3f> frame_points(const FrameRecord& record, const FrameSource& drive) {
  const DriveInfo& info = drive.info();
  if (record.index < info.begin || record.index >= info.end) return {};
  const LoadedFrame loaded = drive.load(record.index);
  if (std::holds_alternative<SkippedFrame>(loaded)) return {};
  const PlacedFrame placed{record.index, record.T_local_lidar, record.motion};
  return matched_points(compensated_scan(std::get<Frame>(loaded).scan, placed, info),
                        info.calibration.cameras);
}

struct Sum {
  double distance = 0;
  std::size_t points = 0;
  Sum& operator+=(const Sum& other) {
    distance += other.distance;
    points += other.points;
    return *this;
  }
};

Sum match(const std::vector<Eigen::Vector3f>& source, const std::vector<Eigen::Vector3f>& target,
          const RigidMotion& T_target_source) {
  if (target.empty()) return {};
  const KdTree tree(target);
  constexpr std::size_t kGrain = 4096;
  return parallel_sum(source.size(), kGrain, Sum{}, [&](std::size_t begin, std::size_t end) {
    Sum sum;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f p = (T_target_source * source[i].cast<double>()).cast<float>();
      const KdTree::Neighbor nearest = tree.nearest(p, kMaxDistance);
      if (!(nearest.squared_distance < kMaxDistance * kMaxDistance)) continue;
      sum += {std::sqrt(double(nearest.squared_distance)), 1};
    }
    return sum;
  });
}

ScanMatching figures_of(const Sum& sum, std::size_t pairs) {
  ScanMatching result;
  result.points = sum.points;
  result.pairs = pairs;
  if (sum.points > 0) result.mean = sum.distance / static_cast<double>(sum.points);
  return result;
}

}  // namespace

std::vector<Eigen::Vector3f> matched_points(const PointCloud& scan_lidar,
                                            const std::vector<Camera>& cameras) {
  const std::vector<std::uint8_t> ground = segment_ground(scan_lidar.position, GroundOptions{});
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < scan_lidar.size(); ++i) {
    if (ground[i] != 0) continue;
    const Eigen::Vector3d p = scan_lidar.position[i].cast<double>();
    for (const Camera& camera : cameras) {
      const auto pixel = camera.project(camera.T_cam_lidar * p);
      if (!pixel || !camera.in_view(*pixel)) continue;
      points.push_back(scan_lidar.position[i]);
      break;
    }
  }
  return points;
}

ScanMatching match_scans(const std::vector<Eigen::Vector3f>& source,
                         const std::vector<Eigen::Vector3f>& target,
                         const RigidMotion& T_target_source) {
  return figures_of(match(source, target, T_target_source), 1);
}

ScanMatching scan_matching(const ScoredMap& map, const FrameSource& drive) {
  std::size_t pairs = 0;
  Sum sum;
  const FrameRecord* before = nullptr;
  std::vector<Eigen::Vector3f> target;
  for (const FrameRecord& record : map.frames) {
    if (record.status != FrameStatus::kMapped) continue;
    std::vector<Eigen::Vector3f> source = frame_points(record, drive);
    if (source.empty()) continue;
    if (before != nullptr) {
      sum += match(source, target, before->T_local_lidar.inverse() * record.T_local_lidar);
      ++pairs;
    }
    before = &record;
    target = std::move(source);
  }
  return figures_of(sum, pairs);
}

}  // namespace fovea
