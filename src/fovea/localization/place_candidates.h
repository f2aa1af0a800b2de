// Places to try for a scan whose place is unknown: where the drives of the map went.
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/map/frame_record.h"

namespace fovea {

class PlaceCandidates {
 public:
  /// Adds poses some meters apart along the drives, either way round.
  /// @param frames  of the drives, in order
  void add(const std::vector<FrameRecord>& frames);

  bool empty() const { return candidates_.empty(); }
  /// Of the first frame. There must be one.
  const RigidMotion& first() const { return candidates_.front().T_local_lidar; }

  /// The next place to try: of those least tried the nearest one. There must be one.
  RigidMotion next(const Eigen::Vector3d& near_local);
  /// Forgets what was tried.
  void restart();

 private:
  struct Candidate {
    RigidMotion T_local_lidar;
    double handicap = 0;  // m
    std::size_t tried = 0;
  };
  std::vector<Candidate> candidates_;
};

}  // namespace fovea
