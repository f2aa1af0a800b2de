// The target of the default registration: recent scans around the vehicle (docs/method.md 2.5).
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "fovea/geometry/point_index.h"
#include "fovea/mapping/registration/normals.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/mapping/registration/voxel_queues.h"
#include "fovea/rigid_motion.h"

namespace fovea {

struct LocalMapOptions {
  int max_keyframes = 10;  ///< scans in the map
  /// Selection of the scans to add (Keyframes).
  double keyframe_distance = 1.5;                  ///< m; 0: all scans
  double keyframe_rotation = 0.04363323129985824;  ///< rad
  double keyframe_overlap = 0.8;                   ///< 0 to 1
  double max_range = 120.0;  ///< m from a scan's sensor; points further away are left out
  double voxel = 0.25;       ///< m, at most one point for each voxel; 0 keeps all
};

/// The last scans of known pose, thinned to one point for each voxel. The oldest scan in a voxel
/// provides this point, so the target changes and drifts least.
///
/// Normals belong to the map. A normal is fitted to the points of all scans around a target point,
/// as soon as these points determine it. One scan of a sparse LiDAR is not enough: nearby points
/// lie on one ring. Rings of later scans fill the gaps.
///
/// The map is a pure function of its options and the last memory() scans with their poses. A
/// resumed run adds these scans again and gets an identical target.
class LocalMap {
 public:
  /// A cloud to register against, in `odom` axes relative to an origin near the vehicle. Floats
  /// thus stay precise at any distance from the origin of `local`.
  struct Target {
    Eigen::Vector3d origin_odom = Eigen::Vector3d::Zero();  ///< of the points
    RegistrationCloud cloud;  ///< may contain unused slots, which are not in `index`
    PointIndex index;         ///< over cloud.points
  };

  /// @param normals  of the target; the spacing is always `voxel`. Absent: point to point
  explicit LocalMap(const LocalMapOptions& options,
                    std::optional<NormalOptions> normals = NormalOptions());

  /// Adds a scan. Removes the oldest scan if there are max_keyframes already.
  /// @param points_lidar  thinned
  void add(std::vector<Eigen::Vector3f> points_lidar, const RigidMotion& T_odom_lidar);

  /// Number of added scans that the target depends on. It includes removed scans: normals of
  /// present points were fitted while these scans were in the map.
  static int memory(const LocalMapOptions& options) { return 2 * options.max_keyframes - 1; }

  /// Removes all scans.
  void clear() { keyframes_.clear(); }

  bool empty() const { return keyframes_.empty(); }
  /// Number of target points.
  std::size_t size() const { return target_.cloud.points.size() - free_slots_.size(); }

  /// std::logic_error if the map is empty. Valid until the next add().
  const Target& target() const;

 private:
  static constexpr std::uint32_t kNoSlot = 0xffffffffu;
  struct Keyframe {
    std::uint32_t number = 0;
    std::vector<Eigen::Vector3f> points_lidar;
    RigidMotion T_odom_lidar;
    std::vector<Eigen::Vector3f> points;  // relative to the target's origin
    std::vector<std::uint32_t> slot;      // in the target; kNoSlot if not a target point
    std::vector<VoxelQueues::Item> next;  // successor of each point in its voxel
  };
  void insert(Keyframe& keyframe);
  /// Makes one point of a keyframe a target point.
  void insert_target(Keyframe& keyframe, std::uint32_t index);
  void remove_oldest();
  /// Builds the target again around another origin.
  void rebuild(const Eigen::Vector3d& origin_odom);
  /// Fits normals to target points that have none yet.
  void fit_normals();
  auto next_of();

  LocalMapOptions options_;
  std::optional<NormalOptions> normals_;
  std::deque<Keyframe> keyframes_;  // oldest first
  std::uint32_t next_number_ = 0;
  VoxelQueues voxels_;
  Target target_;
  std::vector<std::uint32_t> free_slots_;  // in the target
};

/// Registers a scan to the map. T_target_source of the guess, the prior and the result is
/// T_odom_lidar.
RegistrationResult register_to(const LocalMap& map, const RegistrationCloud& source_lidar,
                               const RigidMotion& guess_T_odom_lidar,
                               const RegistrationOptions& options,
                               std::optional<PosePrior> prior = std::nullopt);

/// Fit of a scan to the vertical surfaces of the map. Surfaces across and along the LiDAR's x axis
/// are judged separately, and the worse fit counts: the walls of a street fit anywhere along the
/// street. Ground is excluded because it fits everywhere.
struct VerticalFit {
  std::size_t points = 0;  ///< near these surfaces, of about 1500 sampled points of the scan
  double share = 0;        ///< share of these points within 10 cm of the surface

  /// Enough points are near vertical surfaces, and too few of them fit: the pose is wrong. Correct
  /// poses have a share of 0.5 (16 rings, moving cars) to 0.98, wrong ones of 0.1 to 0.5.
  bool contradicts() const { return points >= kLeastPoints && share < kLeastShare; }
  /// Enough points are near vertical surfaces, and enough of them fit.
  bool confirms() const { return points >= kLeastPoints && share >= kLeastShare; }

  static constexpr std::size_t kLeastPoints = 30;
  static constexpr double kLeastShare = 0.45;
};
VerticalFit vertical_fit(const LocalMap& map, const RegistrationCloud& source_lidar,
                         const RigidMotion& T_odom_lidar);

}  // namespace fovea
