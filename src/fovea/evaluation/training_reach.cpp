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
    Training frame{record.T_local_lidar.inverse(), {}};
    for (std::size_t k = 0; k < cameras_.size(); ++k) {
      if (!record.lacks_image(cameras_[k].index)) frame.cameras.push_back(k);
    }
    training_.push_back(std::move(frame));
  }
}

std::vector<std::uint8_t> TrainingReach::reached(const std::vector<Eigen::Vector3f>& positions,
                                                 const Eigen::Vector3d& origin_local,
                                                 const Eigen::Vector3d& lidar_local) const {
  std::vector<const Training*> near;  // others' white zones cannot hold any of the points
  for (const Training& frame : training_) {
    if ((frame.T_lidar_local * lidar_local).norm() < 2 * kEvaluatedFar + 1) near.push_back(&frame);
  }
  const auto in_view = [&](const Training& frame, const Eigen::Vector3d& p_lidar) {
    return cameras_.empty() ||
           std::any_of(frame.cameras.begin(), frame.cameras.end(), [&](std::size_t k) {
             const Eigen::Vector3d p_cam = cameras_[k].T_cam_lidar * p_lidar;
             return scored_pixel(cameras_[k], p_cam).has_value();
           });
  };
  std::vector<std::uint8_t> marks(positions.size(), 0);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3d p_local = positions[i].cast<double>() + origin_local;
    marks[i] = std::any_of(near.begin(), near.end(), [&](const Training* frame) {
      const Eigen::Vector3d p_lidar = frame->T_lidar_local * p_local;
      const double range = p_lidar.norm();
      return range > kEvaluatedNear && range < kEvaluatedFar && in_view(*frame, p_lidar);
    });
  }
  return marks;
}

}  // namespace fovea
