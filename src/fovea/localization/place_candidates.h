// Where a vehicle may be that does not know where it is: where the map's own vehicle has been.
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/map/frame_record.h"

namespace fovea {

class PlaceCandidates {
 public:
  /// Poses some metres apart along the map's drives, either way round.
  explicit PlaceCandidates(const std::vector<FrameRecord>& frames);

  bool empty() const { return candidates_.empty(); }
  /// Of the map's first frame.
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
