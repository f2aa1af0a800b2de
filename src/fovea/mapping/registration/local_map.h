// The target of our default registration: recent scans around the vehicle (docs/method.md 2.5).
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "fovea/geometry/point_index.h"
#include "fovea/geometry/rigid_motion.h"
#include "fovea/mapping/registration/normals.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/mapping/registration/voxel_queues.h"

namespace fovea {

struct LocalMapOptions {
  int max_keyframes = 10;  ///< scans in the map
  /// Whoever adds scans adds those whose sensor has moved or turned so far since the one added
  /// before, and those of which less than a share is in the map (Keyframes).
  double keyframe_distance = 1.5;                  ///< m; 0: all scans are
  double keyframe_rotation = 0.04363323129985824;  ///< rad
  double keyframe_overlap = 0.8;                   ///< 0 to 1
  double max_range = 120.0;  ///< m from a scan's sensor; its points further away are left out
  double voxel = 0.25;       ///< m, at most one point a voxel; 0 keeps all
  void validate() const;     ///< ConfigError that names the field
};

/// The last scans of known pose, thinned to one point a voxel: that of the oldest scan that has one
/// there, so that the target changes least from scan to scan, and drifts least.
///
/// Planes belong to the map. A plane is fitted to the points of all scans around a target point, as
/// soon as these determine it. One scan of a sparse LiDAR cannot: its points near a place lie on
/// one ring, and the rings of later scans fill the gaps.
///
/// A pure function of the last memory() scans and poses added (and the options): a run that resumes
/// and adds those again gets the same target, bit by bit.
class LocalMap {
 public:
  /// A cloud to register against, in `local` axes relative to a point near the vehicle, so that
  /// floats stay precise however far the vehicle is from local's origin.
  struct Target {
    Eigen::Vector3d origin_local = Eigen::Vector3d::Zero();  ///< of the points
    RegistrationCloud cloud;  ///< with places in it that are empty: those that `index` never finds
    PointIndex index;         ///< over cloud.points
  };

  /// @param normals  of the target; its spacing is `voxel` in any case. Absent: point to point
  explicit LocalMap(const LocalMapOptions& options,
                    std::optional<NormalOptions> normals = NormalOptions());

  /// Adds a scan and forgets the one max_keyframes before it.
  /// @param points_lidar  thinned
  void add(std::vector<Eigen::Vector3f> points_lidar, const RigidMotion& T_local_lidar);

  /// Number of added scans that the target depends on: a plane of a present scan was fitted when
  /// the scans before it were present.
  static int memory(const LocalMapOptions& options) { return 2 * options.max_keyframes - 1; }

  /// Forgets all scans.
  void clear() { keyframes_.clear(); }

  bool empty() const { return keyframes_.empty(); }
  /// How many points the target has.
  std::size_t size() const { return target_.cloud.points.size() - empty_.size(); }

  /// std::logic_error if the map is empty. Valid until the next add().
  const Target& target() const;

 private:
  static constexpr std::uint32_t kNoPlace = 0xffffffffu;
  struct Keyframe {
    std::uint32_t number = 0;
    std::vector<Eigen::Vector3f> points_lidar;
    RigidMotion T_local_lidar;
    std::vector<Eigen::Vector3f> points;  // placed: about the target's origin
    std::vector<std::uint32_t> place;     // in the target, of those that stand for their voxels
    std::vector<VoxelQueues::Item> next;  // behind each point in its voxel
  };
  void place(Keyframe& keyframe);
  void stand(Keyframe& keyframe, std::uint32_t index);
  void forget_oldest();
  void start_at(const Eigen::Vector3d& origin_local);
  /// Fits planes to target points that have none yet.
  void find_planes();
  auto next_of();

  LocalMapOptions options_;
  std::optional<NormalOptions> normals_;
  std::deque<Keyframe> keyframes_;  // oldest first
  std::uint32_t next_number_ = 0;
  VoxelQueues voxels_;
  Target target_;
  std::vector<std::uint32_t> empty_;  // places in the target
};

/// Registers a scan to the map. T_target_source of the guess, the prior and the result is
/// T_local_lidar.
RegistrationResult register_to(const LocalMap& map, const RegistrationCloud& source_lidar,
                               const RigidMotion& guess_T_local_lidar,
                               const RegistrationOptions& options,
                               std::optional<PosePrior> prior = std::nullopt);

/// How well a scan lies on the vertical surfaces of the map: on those across the LiDAR's x axis, or
/// on those along it, whichever fits worse. A street's walls fit wherever along it the vehicle is;
/// the ground fits everywhere.
struct VerticalFit {
  std::size_t points = 0;  ///< near these surfaces, of some 1500 points of the scan
  double share = 0;        ///< of these, the points within 10 cm of the surface

  /// A pose is wrong if enough points can tell, and too few of them fit. Right poses have a share
  /// of 0.5 (16 rings, moving cars) to 0.98, wrong ones of 0.1 to 0.5.
  bool contradicts() const { return points >= kLeastPoints && share < kLeastShare; }
  /// Enough points can tell, and enough of them fit.
  bool confirms() const { return points >= kLeastPoints && share >= kLeastShare; }

  static constexpr std::size_t kLeastPoints = 30;
  static constexpr double kLeastShare = 0.45;
};
VerticalFit vertical_fit(const LocalMap& map, const RegistrationCloud& source_lidar,
                         const RigidMotion& T_local_lidar);

}  // namespace fovea
