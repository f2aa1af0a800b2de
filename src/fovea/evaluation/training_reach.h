// Where the frames that built a map could have seen (docs/method.md 7): of a block of held-out
// frames only that can be asked of the map.
#pragma once

#include <utility>
#include <vector>

#include "fovea/evaluation/evaluated_set.h"
#include "fovea/map/frame_record.h"

namespace fovea {

/// First and last index of each run of scored frames that no mapped frame interrupts.
std::vector<std::pair<int, int>> scored_blocks(const std::vector<PlacedFrame>& scored,
                                               const std::vector<FrameRecord>& frames);

class TrainingReach {
 public:
  /// @param frames   of the map; the mapped ones count
  /// @param cameras  that coloured it; none: any direction is in view
  TrainingReach(const std::vector<FrameRecord>& frames, std::vector<Camera> cameras);

  /// Marks (1) the points that lay in the white zone (3-15 m) of a mapped frame and in the view of
  /// one of its cameras that had an image; that something may have stood before them is not asked.
  /// @param positions     local frame, relative to origin_local, all within 15 m of `lidar_local`
  std::vector<std::uint8_t> reached(const std::vector<Eigen::Vector3f>& positions,
                                    const Eigen::Vector3d& origin_local,
                                    const Eigen::Vector3d& lidar_local) const;

 private:
  struct Training {
    RigidMotion T_lidar_local;
    std::vector<std::size_t> cameras;  // places of those that had an image
  };
  std::vector<Training> training_;
  std::vector<Camera> cameras_;
};

}  // namespace fovea
