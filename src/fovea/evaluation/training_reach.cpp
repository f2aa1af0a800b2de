#include "fovea/evaluation/training_reach.h"

#include <algorithm>

namespace fovea {

std::vector<std::pair<int, int>> scored_blocks(const std::vector<PlacedFrame>& scored,
                                               const std::vector<FrameRecord>& frames) {
  std::vector<std::pair<int, int>> blocks;
  auto next = scored.begin();
  bool open = false;
  for (const FrameRecord& record : frames) {
    if (next != scored.end() && next->index == record.index) {
      if (!open) blocks.emplace_back(record.index, record.index);
      blocks.back().second = record.index;
      open = true;
      ++next;
    } else if (record.status == FrameStatus::kMapped) {
      open = false;
    }
  }
  return blocks;
}

TrainingReach::TrainingReach(const std::vector<FrameRecord>& frames, std::vector<Camera> cameras)
    : cameras_(std::move(cameras)) {
  for (const FrameRecord& record : frames) {
    if (record.status != FrameStatus::kMapped) continue;
    T_lidar_local_.push_back(record.T_local_lidar.inverse());
  }
}

std::vector<std::uint8_t> TrainingReach::reached(const std::vector<Eigen::Vector3f>& positions,
                                                 const Eigen::Vector3d& origin_local,
                                                 const Eigen::Vector3d& lidar_local) const {
  std::vector<const RigidMotion*> near;  // others' white zones cannot hold any of the points
  for (const RigidMotion& T_lidar_local : T_lidar_local_) {
    if ((T_lidar_local * lidar_local).norm() < 2 * kEvaluatedFar + 1)
      near.push_back(&T_lidar_local);
  }
  const auto in_view = [&](const Eigen::Vector3d& p_lidar) {
    return cameras_.empty() ||
           std::any_of(cameras_.begin(), cameras_.end(), [&](const Camera& camera) {
             return scored_pixel(camera, Eigen::Vector3d(camera.T_cam_lidar * p_lidar)).has_value();
           });
  };
  std::vector<std::uint8_t> marks(positions.size(), 0);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3d p_local = positions[i].cast<double>() + origin_local;
    marks[i] = std::any_of(near.begin(), near.end(), [&](const RigidMotion* T_lidar_local) {
      const Eigen::Vector3d p_lidar = *T_lidar_local * p_local;
      const double range = p_lidar.norm();
      return range > kEvaluatedNear && range < kEvaluatedFar && in_view(p_lidar);
    });
  }
  return marks;
}

}  // namespace fovea
