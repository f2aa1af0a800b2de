// Which of a drive's labelled boxes moved: what was in them is neither scored nor map
// (docs/method.md 7). The paper removed moving objects by hand.
#pragma once

#include <vector>

#include "fovea/drive/kitti/tracklets.h"
#include "fovea/map/frame_record.h"

namespace fovea {

class MovingBoxes {
 public:
  /// A box has moved if two of its places (its middle, in the local frame) lie farther apart (m).
  static constexpr double kMoved = 0.5;
  /// Points this far outside still belong to a box (m): boxes are drawn by hand.
  static constexpr double kMargin = 0.1;

  /// @param frames  whose poses place the boxes; skipped ones do not count
  MovingBoxes(const std::vector<Tracklet>& tracklets, const std::vector<FrameRecord>& frames);

  std::size_t labelled() const { return labelled_; }
  std::size_t moved() const { return moved_.size(); }
  /// Whether a point (LiDAR frame of `frame`) is in a box that moved at any time.
  bool contain(int frame, const Eigen::Vector3d& p_lidar) const;

 private:
  std::size_t labelled_;
  std::vector<Tracklet> moved_;
};

}  // namespace fovea
