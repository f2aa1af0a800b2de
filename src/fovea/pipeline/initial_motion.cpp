#include "fovea/pipeline/initial_motion.h"

#include "fovea/base/time.h"
#include "fovea/geometry/point_index.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/ground.h"
#include "fovea/pipeline/frame_motion.h"
#include "fovea/pipeline/pose_refiner.h"
#include "fovea/sensor/motion_compensation.h"

namespace fovea {
namespace {

constexpr double kLongestGap = 1.0;  // s from the first scan to the second
constexpr double kFastest = 60;      // m/s

/// The search begins at rest and at steps along each of the LiDAR's axes, either way: at most half
/// as far apart as pairs may be (m), and at least two steps up to this speed (m/s).
constexpr double kLongestStep = 3;
constexpr double kStartSpeed = 30;
/// How far apart its pairs may be, first and then, with their kernels (m).
constexpr double kFar = 4, kFarWidth = 1;
constexpr double kNear = 1, kNearWidth = 0.3;

/// The motion has settled when it changes by less from one registration to the next (m, rad). Each
/// takes what is wrong to a few hundredths of it.
constexpr double kSettledWay = 3e-3, kSettledTurn = 3e-4;
constexpr int kMostRegistrations = 8;

/// The first usable frame from `begin` on.
std::optional<Frame> usable_frame(const FrameSource& source, int begin) {
  for (const int index : source.info().frame_indices()) {
    if (index < begin) continue;
    LoadedFrame result = source.load(index);
    if (auto* frame = std::get_if<Frame>(&result)) return std::move(*frame);
  }
  return std::nullopt;
}

std::vector<RigidMotion> first_guesses(double elapsed) {
  std::vector<RigidMotion> guesses{RigidMotion::Identity()};
  const double farthest = kStartSpeed * elapsed;
  const int steps = std::max(2, static_cast<int>(std::ceil(farthest / kLongestStep)));
  for (int i = 1; i <= steps; ++i) {
    const double way = farthest * i / steps;
    for (const Eigen::Vector3d& start :
         {Eigen::Vector3d(way, 0, 0), {-way, 0, 0}, {0, way, 0}, {0, -way, 0}}) {
      guesses.emplace_back(Eigen::Translation3d(start));
    }
  }
  return guesses;
}

/// Two scans, and how the second lies to the first.
class ScanPair {
 public:
  ScanPair(const DriveInfo& drive, const Frame& first, const Frame& second, bool compensate)
      : drive_(drive),
        first_(first.scan),
        second_(second.scan),
        elapsed_(seconds(second.stamp - first.stamp)),
        height_(sensor_height(first.scan.position).value_or(kUsualSensorHeight)),
        compensate_(compensate && !drive.sweep_compensated) {
    options_.max_correction_translation = kFastest * elapsed_;
    // Of two scans, each has its own planes.
    options_.registration.method = RegistrationMethod::kGicp;
  }

  /// T_first_second, the sweeps as they are, to some decimetres: by what stands, since the rings of
  /// a LiDAR on the ground are the same wherever it goes.
  RigidMotion found() const {
    const RegistrationCloud first = standing(first_), second = standing(second_);
    const PointIndex index(first.points, options_.voxel);
    RegistrationOptions far = options_.registration, near = options_.registration;
    far.max_distance = kFar;
    far.robust_width = kFarWidth;
    near.max_distance = kNear;
    near.robust_width = kNearWidth;
    RigidMotion best = RigidMotion::Identity();
    double best_fit = 0;
    for (const RigidMotion& guess : first_guesses(elapsed_)) {
      const RigidMotion nearby = register_clouds(first, index, second, guess, far).T_target_source;
      const RegistrationResult result = register_clouds(first, index, second, nearby, near);
      if (!result.converged || fit_of(result, near) <= best_fit) continue;
      best_fit = fit_of(result, near);
      best = result.T_target_source;
    }
    return best;
  }

  /// T_first_second of the sweeps undone by a guess of it, from that guess; nothing where that
  /// fails.
  std::optional<RigidMotion> registered(const RigidMotion& guess) const {
    const Twist velocity = velocity_of(guess);
    StageClock unused;
    PoseRefiner refiner(options_, drive_.calibration.cameras);
    refiner.keep(refiner.prepare(undone(first_, velocity), unused), RigidMotion::Identity(),
                 unused);
    const RefinedPose refined = refiner.refine(undone(second_, velocity), guess, unused);
    if (!refined.note.empty()) return std::nullopt;
    return refined.T_odom_lidar;
  }

  Twist velocity_of(const RigidMotion& T_first_second) const {
    return velocity_between(RigidMotion::Identity(), T_first_second, elapsed_);
  }

 private:
  PointCloud undone(PointCloud scan, const Twist& velocity) const {
    if (compensate_) compensate_sweep(scan, {velocity}, drive_.sweep);
    return scan;
  }

  RegistrationCloud standing(const PointCloud& scan) const {
    const std::vector<std::uint8_t> ground =
        segment_ground(scan.position, {.method = GroundMethod::kRansac, .sensor_height = height_});
    std::vector<Eigen::Vector3f> points;
    for (std::size_t i = 0; i < ground.size(); ++i) {
      if (ground[i] == 0) points.push_back(scan.position[i]);
    }
    return prepare_cloud(voxel_thinned(std::move(points), static_cast<float>(options_.voxel)),
                         options_.registration, options_.voxel);
  }

  const DriveInfo& drive_;
  const PointCloud &first_, &second_;
  double elapsed_;  // s
  double height_;   // m, of the LiDAR above the ground
  bool compensate_;
  /// What the mapper registers by unless told otherwise, whatever it is told: this finds the first
  /// guess, which is not what options compare.
  RefinementOptions options_;
};

std::optional<Twist> velocity_by_registration(const ScanPair& scans) {
  std::optional<RigidMotion> T_first_second = scans.found();
  for (int i = 0; T_first_second && i < kMostRegistrations; ++i) {
    const auto next = scans.registered(*T_first_second);
    const RigidMotion change = next ? T_first_second->inverse() * *next : RigidMotion::Identity();
    T_first_second = next;
    if (change.translation().norm() < kSettledWay &&
        rotation_angle(change.linear()) < kSettledTurn) {
      break;
    }
  }
  if (!T_first_second) return std::nullopt;
  return scans.velocity_of(*T_first_second);
}

}  // namespace

std::optional<Twist> initial_velocity(const FrameSource& source,
                                      const std::vector<RigidMotion>& given_poses, int begin,
                                      bool compensate) {
  const DriveInfo& drive = source.info();
  if (const auto known = known_motion(source, given_poses, begin)) {
    if (drive.navigation) return std::nullopt;
    return known->sweep.velocity;
  }
  const auto first = usable_frame(source, begin);
  const auto second = first ? usable_frame(source, first->index + 1) : std::nullopt;
  if (!second || second->stamp <= first->stamp ||
      seconds(second->stamp - first->stamp) > kLongestGap) {
    return std::nullopt;
  }
  return velocity_by_registration({drive, *first, *second, compensate});
}

}  // namespace fovea
