#include "fovea/evaluation/moving_boxes.h"

#include <algorithm>

namespace fovea {
namespace {

bool has_moved(const Tracklet& tracklet, const std::vector<FrameRecord>& frames) {
  std::vector<Eigen::Vector3d> places;
  for (const FrameRecord& record : frames) {
    if (record.status == FrameStatus::kSkipped) continue;
    const RigidMotion* pose = tracklet.at(record.index);
    if (pose == nullptr) continue;
    const Eigen::Vector3d place = record.T_local_lidar * pose->translation();
    for (const Eigen::Vector3d& other : places) {
      if ((place - other).norm() > MovingBoxes::kMoved) return true;
    }
    places.push_back(place);
  }
  return false;
}

}  // namespace

MovingBoxes::MovingBoxes(const std::vector<Tracklet>& tracklets,
                         const std::vector<FrameRecord>& frames)
    : labelled_(tracklets.size()) {
  std::copy_if(tracklets.begin(), tracklets.end(), std::back_inserter(moved_),
               [&](const Tracklet& tracklet) { return has_moved(tracklet, frames); });
}

bool MovingBoxes::contain(int frame, const Eigen::Vector3d& p_lidar) const {
  return std::any_of(moved_.begin(), moved_.end(), [&](const Tracklet& tracklet) {
    return tracklet.contains(frame, p_lidar, kMargin);
  });
}

}  // namespace fovea
