// Recognises places: scans of earlier submaps near the vehicle, and what registration says of them.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "fovea/base/scratch_file.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// A place seen again.
struct LoopClosure {
  std::size_t submap = 0;  ///< the earlier one
  RigidMotion T_submap_lidar = RigidMotion::Identity();
};

/// Where an earlier submap is believed to lie, and how wrong that may be.
struct LoopCandidate {
  std::size_t submap = 0;
  RigidMotion T_submap_lidar = RigidMotion::Identity();  ///< of the new scan, by all poses so far
  double path = 0;                                       ///< m driven since the submap was made
};

/// One scan a submap, thinned, to register later scans against. The scans lie in a scratch file, so
/// that memory does not grow with the drive.
class LoopCloser {
 public:
  /// @param registration  of the front end; the method here is always generalised ICP
  explicit LoopCloser(const RegistrationOptions& registration);

  /// Keeps a scan of a submap.
  /// @param points_lidar  finite
  void add(std::size_t submap, const std::vector<Eigen::Vector3f>& points_lidar,
           const RigidMotion& T_submap_lidar);
  bool has(std::size_t submap) const { return scans_.contains(submap); }

  /// Registers a scan against the most promising of the candidates: the nearest ones within reach
  /// of the drift that their paths allow. A closure must fit as well as neighbouring scans do.
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
