// Loop closure: registers scans to scans of earlier submaps near the vehicle.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "fovea/core/scratch_file.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// The pose of a scan relative to an earlier submap.
struct LoopClosure {
  std::size_t submap = 0;  ///< the earlier one
  RigidMotion T_submap_lidar = RigidMotion::Identity();
};

/// An earlier submap near the vehicle.
struct LoopCandidate {
  std::size_t submap = 0;
  RigidMotion T_submap_lidar = RigidMotion::Identity();  ///< of the new scan, by the poses so far
  double path = 0;                                       ///< m driven since the submap began
};

/// Keeps one thinned scan of each submap and registers later scans to them. The scans are in a
/// scratch file, so that memory does not grow with the drive.
class LoopCloser {
 public:
  /// @param registration  of the front end, except for the method: generalized ICP
  explicit LoopCloser(const RegistrationOptions& registration);

  /// Keeps a scan of a submap.
  /// @param points_lidar  finite
  void add(std::size_t submap, const std::vector<Eigen::Vector3f>& points_lidar,
           const RigidMotion& T_submap_lidar);
  bool has(std::size_t submap) const { return scans_.contains(submap); }

  /// Registers a scan to the nearest candidates within the possible drift. A closure must fit as
  /// well as consecutive scans.
  /// @param points_lidar  of the new scan, finite
  std::optional<LoopClosure> find(const std::vector<Eigen::Vector3f>& points_lidar,
                                  std::vector<LoopCandidate> candidates) const;

 private:
  struct Scan {
    ScratchFile::Place points, normals;  // of a RegistrationCloud
    RigidMotion T_submap_lidar;
  };
  std::optional<LoopClosure> verify(const RegistrationCloud& cloud_lidar,
                                    const LoopCandidate& candidate) const;

  RegistrationOptions registration_;
  std::map<std::size_t, Scan> scans_;
  ScratchFile clouds_;
};

}  // namespace fovea
