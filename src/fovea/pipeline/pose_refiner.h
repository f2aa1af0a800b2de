// Registration of scans to the local map, and its verdict on the pose.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/mapping/registration/keyframes.h"
#include "fovea/mapping/registration/local_map.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/pipeline/frame_result.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/point_cloud.h"

namespace fovea {

struct RefinedPose {
  RegistrationCloud cloud;  ///< the registered points, LiDAR frame
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  /// How well the scan fits: points with a counterpart, each weighted down with its distance.
  double fit = 0;
  std::string note;           ///< why the first guess was kept; empty if it was not
  bool lost = false;          ///< the scan does not lie on the surfaces of the local map
  bool is_confirmed = false;  ///< vertical surfaces of the local map confirm the pose
  std::optional<RegistrationStats> stats;
};

/// See RefinedPose::fit.
double fit_of(const RegistrationResult& result, const RegistrationOptions& options);

class PoseRefiner {
 public:
  explicit PoseRefiner(const RefinementOptions& options);

  /// The points to register: thinned, with the normals that the method needs.
  RegistrationCloud prepare(const PointCloud& scan_lidar) const;

  /// Registers a scan from a first guess of its pose. A registration that does not converge, or
  /// ends too far from the guess, keeps the guess. So does the first scan: there is no target yet.
  /// @param scan_lidar  motion compensated
  /// @param sigma       of the guess where it counts as a measurement: rad, m
  /// @param doubts      whether the guess is kept if no wall confirms a pose that contradicts it
  RefinedPose refine(const PointCloud& scan_lidar, const RigidMotion& guess_T_odom_lidar,
                     const std::optional<Twist>& sigma = std::nullopt, bool doubts = true) const;

  /// Searches for a lost scan around its first guess, see search_place().
  /// @param reach  m
  /// @return the pose that fits best, or else the first guess and what `lost` says
  RefinedPose search(RefinedPose lost, const RigidMotion& guess_T_odom_lidar, double reach) const;

  /// Lets later scans be registered against this one, where it is.
  void keep(RegistrationCloud cloud_lidar, const RigidMotion& T_odom_lidar);

  /// Forgets all scans: later ones are elsewhere.
  void restart() { local_map_.clear(); }

  /// Chooses the scans to keep, from the first on.
  Keyframes keyframes() const;
  /// How many of the latest target scans all state depends on.
  int memory() const { return LocalMap::memory(options_.local_map); }

 private:
  /// Why navigation is more likely right than the registered pose; empty if it is not.
  std::string doubt_of(const AlignmentStats& alignment, const std::optional<Twist>& sigma,
                       const VerticalFit& fit) const;

  RefinementOptions options_;
  LocalMap local_map_;
};

}  // namespace fovea
