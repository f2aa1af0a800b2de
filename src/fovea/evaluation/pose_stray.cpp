#include "fovea/evaluation/pose_stray.h"

#include <algorithm>
#include <set>

namespace fovea {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

PoseStray pose_stray(const std::vector<FrameRecord>& frames,
                     const std::vector<PlacedFrame>& scored) {
  std::vector<const FrameRecord*> known;
  for (const FrameRecord& record : frames) {
    if (record.status != FrameStatus::kSkipped && record.T_local_lidar_navigation) {
      known.push_back(&record);
    }
  }
  const auto correction = [](const FrameRecord& record) -> Eigen::Vector3d {
    return record.T_local_lidar.translation() - record.T_local_lidar_navigation->translation();
  };
  std::set<int> indices;
  for (const PlacedFrame& placed : scored) indices.insert(placed.index);
  std::vector<double> of_scored, of_mapped;
  for (std::size_t i = 0; i < known.size(); ++i) {
    std::size_t before = i, after = i + 1;
    while (before > 0 && known[before - 1]->status != FrameStatus::kMapped) --before;
    while (after < known.size() && known[after]->status != FrameStatus::kMapped) ++after;
    if (before == 0 || after == known.size()) continue;
    const FrameRecord &low = *known[before - 1], &high = *known[after];
    const double share = double(known[i]->index - low.index) / double(high.index - low.index);
    const Eigen::Vector3d expected = (1 - share) * correction(low) + share * correction(high);
    const double stray = (correction(*known[i]) - expected).norm();
    if (indices.contains(known[i]->index)) {
      of_scored.push_back(stray);
    } else if (known[i]->status == FrameStatus::kMapped) {
      of_mapped.push_back(stray);
    }
  }
  return {median(std::move(of_scored)), median(std::move(of_mapped))};
}

}  // namespace fovea
