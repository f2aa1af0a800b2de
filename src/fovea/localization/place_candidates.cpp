#include "fovea/localization/place_candidates.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace fovea {
namespace {

constexpr double kApart = 4;  // m along the way: registration finds what lies between
/// Vehicles go the same way as the map's more often than the other way, m.
constexpr double kOtherWay = 30;

}  // namespace

void PlaceCandidates::add(const std::vector<FrameRecord>& frames) {
  const RigidMotion turned(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
  const FrameRecord* last = nullptr;
  for (const FrameRecord& frame : frames) {
    if (frame.status == FrameStatus::kSkipped) continue;
    const RigidMotion& T = frame.T_local_lidar;
    if (last && (last->T_local_lidar.translation() - T.translation()).norm() < kApart) continue;
    last = &frame;
    candidates_.push_back({T, 0});
    candidates_.push_back({T * turned, kOtherWay});
  }
}

RigidMotion PlaceCandidates::next(const Eigen::Vector3d& near_local) {
  const auto rank = [&](const Candidate& c) {
    return std::pair(c.tried, c.handicap + (c.T_local_lidar.translation() - near_local).norm());
  };
  Candidate& best =
      *std::min_element(candidates_.begin(), candidates_.end(),
                        [&](const Candidate& a, const Candidate& b) { return rank(a) < rank(b); });
  ++best.tried;
  return best.T_local_lidar;
}

void PlaceCandidates::restart() {
  for (Candidate& candidate : candidates_) candidate.tried = 0;
}

}  // namespace fovea
