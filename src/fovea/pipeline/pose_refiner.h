// Pose refinement (paper: Pose Refinement): ground, constrained upsampling, registration.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/mapping/registration/local_map.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/stage_clock.h"

namespace fovea {

struct RefinedPose {
  RigidMotion T_local_lidar = RigidMotion::Identity();
  std::string note;                       ///< why the first guess was kept; empty if it was not
  std::map<std::string, double> figures;  ///< registration_iterations, _pairs, _rms, ...
};

class PoseRefiner {
 public:
  /// @param cameras  whose view bounds the points where options.visible_only
  PoseRefiner(const RefinementOptions& options, std::vector<Camera> cameras);

  /// Registers a scan from a first guess of its pose. A registration that does not converge, or
  /// ends too far from the guess, keeps the guess. The first scan keeps it too: there is no target
  /// yet.
  /// @param scan_lidar  motion compensated
  /// @param as_target   whether later scans may be registered against this one (not if held out)
  RefinedPose refine(const PointCloud& scan_lidar, const RigidMotion& guess_T_local_lidar,
                     bool as_target, StageClock& clock);

  /// Puts a scan of known pose among the targets (resume).
  void add_target(const PointCloud& scan_lidar, const RigidMotion& T_local_lidar);

  /// How many of the latest target scans all state depends on.
  int memory() const;

 private:
  /// The points to register: in view, ground as it is, the rest upsampled, thinned; with normals.
  RegistrationCloud prepare(const PointCloud& scan_lidar, StageClock& clock) const;
  PointCloud visible_upsampled(const PointCloud& scan_lidar) const;
  RegistrationResult register_scan(const RegistrationCloud& source,
                                   const RigidMotion& guess_T_local_lidar) const;
  void keep_as_target(RegistrationCloud cloud, const RigidMotion& T_local_lidar);

  struct PreviousScan {
    RegistrationCloud cloud;
    RigidMotion T_local_lidar;
  };
  RefinementOptions options_;
  std::vector<Camera> cameras_;
  LocalMap local_map_;
  std::optional<PreviousScan> previous_;
};

}  // namespace fovea
