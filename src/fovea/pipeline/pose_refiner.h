// Pose refinement (paper: Pose Refinement): ground, constrained upsampling, registration.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/mapping/registration/keyframes.h"
#include "fovea/mapping/registration/local_map.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/stage_clock.h"

namespace fovea {

struct RefinedPose {
  RegistrationCloud cloud;  ///< what was registered, LiDAR frame
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  /// How well the scan fits: points with a counterpart, each the less the further it lies.
  double fit = 0;
  std::string note;           ///< why the first guess was kept; empty if it was not
  bool lost = false;          ///< the scan does not lie on the surfaces of the local map
  bool is_confirmed = false;  ///< vertical surfaces of the local map confirm the pose
  std::map<std::string, double> figures;  ///< registration_iterations, _pairs, _rms, ...
};

/// See RefinedPose::fit.
double fit_of(const RegistrationResult& result, const RegistrationOptions& options);

class PoseRefiner {
 public:
  /// @param cameras  whose view bounds the points where options.visible_only
  PoseRefiner(const RefinementOptions& options, std::vector<Camera> cameras);

  /// The points to register: in view, ground as it is, the rest upsampled, thinned; with normals.
  RegistrationCloud prepare(const PointCloud& scan_lidar, StageClock& clock) const;

  /// Registers a scan from a first guess of its pose. A registration that does not converge, or
  /// ends too far from the guess, keeps the guess. The first scan keeps it too: there is no target
  /// yet.
  /// @param scan_lidar  motion compensated
  /// @param sigma       of the guess where it counts as a measurement: rad, m. Used with the local
  /// map
  RefinedPose refine(const PointCloud& scan_lidar, const RigidMotion& guess_T_odom_lidar,
                     StageClock& clock, const std::optional<Twist>& sigma = std::nullopt) const;

  /// Searches for a scan that is lost around its first guess, see search_place().
  /// @param reach  m
  /// @return the pose that fits best, or else the first guess and what `lost` says
  RefinedPose search(RefinedPose lost, const RigidMotion& guess_T_odom_lidar, double reach,
                     StageClock& clock) const;

  /// Lets later scans be registered against this one, where it is.
  void keep(RegistrationCloud cloud_lidar, const RigidMotion& T_odom_lidar, StageClock& clock);

  /// Forgets all scans: later ones are elsewhere.
  void restart();
  /// Whether refine() can confirm poses: only the local map has planes to compare with.
  bool confirms_poses() const {
    return options_.target == RegistrationTarget::kLocalMap &&
           options_.registration.method != RegistrationMethod::kPointToPoint;
  }

  /// Chooses the scans that are to be kept, from the first on.
  Keyframes keyframes() const;
  /// How many of the latest target scans all state depends on.
  int memory() const;

 private:
  PointCloud visible_upsampled(const PointCloud& scan_lidar) const;
  RegistrationResult register_scan(const RegistrationCloud& source,
                                   const RigidMotion& guess_T_odom_lidar,
                                   const std::optional<Twist>& sigma) const;

  /// Why the pose of a registration is not taken; empty if it is.
  /// @param correction  from the first guess to that pose
  /// @param fit         of that pose
  std::string objection_to(const RegistrationResult& result, const RigidMotion& correction,
                           const std::optional<Twist>& sigma, const VerticalFit& fit) const;

  struct PreviousScan {
    RegistrationCloud cloud;
    RigidMotion T_odom_lidar;
  };
  RefinementOptions options_;
  std::vector<Camera> cameras_;
  LocalMap local_map_;
  std::optional<PreviousScan> previous_;
};

}  // namespace fovea
