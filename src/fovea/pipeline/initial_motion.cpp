#include "fovea/pipeline/initial_motion.h"

#include "fovea/deskew.h"
#include "fovea/geometry/point_index.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/ground.h"
#include "fovea/pipeline/frame_motion.h"
#include "fovea/pipeline/pose_refiner.h"
#include "fovea/pipeline/scan_geometry.h"
#include "fovea/time.h"

namespace fovea {
namespace {

constexpr double kLongestGap = 1.0;  // s from the first scan to the second
constexpr double kFastest = 60;      // m/s

/// The search starts at rest and at steps along both directions of the LiDAR's axes. A step is at
/// most kLongestStep (m), and there are at least two up to kStartSpeed (m/s).
constexpr double kLongestStep = 3;
constexpr double kStartSpeed = 30;
/// Maximum distances of pairs, first and then, with the widths of their kernels (m).
constexpr double kFar = 4, kFarWidth = 1;
constexpr double kNear = 1, kNearWidth = 0.3;

/// The motion has converged if one registration changes it by less than this (m, rad). Each reduces
/// the error to a few hundredths.
constexpr double kConvergedTranslation = 3e-3, kConvergedRotation = 3e-4;
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
    const double distance = farthest * i / steps;
    for (const Eigen::Vector3d& start : {Eigen::Vector3d(distance, 0, 0),
                                         {-distance, 0, 0},
                                         {0, distance, 0},
                                         {0, -distance, 0}}) {
      guesses.emplace_back(Eigen::Translation3d(start));
    }
  }
  return guesses;
}

/// Two scans, for the motion between them.
class ScanPair {
 public:
  ScanPair(const DriveInfo& drive, const Frame& first, const Frame& second, bool compensate)
      : drive_(drive),
        first_(first.scan),
        second_(second.scan),
        first_stamp_(first.stamp),
        second_stamp_(second.stamp),
        elapsed_(seconds(second.stamp - first.stamp)),
        height_(sensor_height(first.scan.position).value_or(kUsualSensorHeight)),
        compensate_(compensate && !drive.sweep_compensated) {
    options_.limits.translation_m = kFastest * elapsed_;
    // Of two scans, each has its own planes.
    options_.registration.method = RegistrationMethod::kGicp;
  }

  /// T_first_second of the raw sweeps, to a few decimeters. Uses no ground points, since rings on
  /// the ground look the same everywhere.
  RigidMotion find_coarse() const {
    const RegistrationCloud first = without_ground(first_), second = without_ground(second_);
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

  /// The velocity at the first scan under which registration finds the second one where the IMU
  /// has it, begun at a guess; empty if registration fails or does not converge.
  std::optional<Twist> velocity_by_imu(Twist velocity) const {
    for (int i = 0; i < kMostRegistrations; ++i) {
      InertialFilter filter(*drive_.imu);
      filter.begin(first_stamp_, {RigidMotion::Identity(), velocity, /*is_level=*/false});
      const InertialPrediction first = filter.predict(first_stamp_),
                               second = filter.predict(second_stamp_);
      const SweepMotion motion = filter.motion(first, sweep_span(first_, drive_));
      PoseRefiner refiner(options_);
      refiner.keep(refiner.prepare(compensated(first_, motion)), RigidMotion::Identity());
      const RefinedPose refined =
          refiner.refine(compensated(second_, filter.motion(second, sweep_span(second_, drive_))),
                         second.T_odom_lidar);
      if (!refined.note.empty()) return std::nullopt;
      velocity.head<3>() = motion.velocity.head<3>();
      const Eigen::Vector3d off =
          refined.T_odom_lidar.translation() - second.T_odom_lidar.translation();
      if (off.norm() < kConvergedTranslation) return velocity;
      velocity.tail<3>() += off / elapsed_;
    }
    return std::nullopt;
  }

  bool has_imu() const {
    if (!drive_.imu || !compensate_) return false;
    const InertialFilter filter(*drive_.imu);
    return filter.covers(first_stamp_) && filter.covers(second_stamp_);
  }

  /// T_first_second by registration from a guess, after motion compensation by the guess; empty if
  /// that fails.
  std::optional<RigidMotion> refine(const RigidMotion& guess) const {
    const Twist velocity = velocity_of(guess);
    PoseRefiner refiner(options_);
    refiner.keep(refiner.prepare(compensated(first_, velocity)), RigidMotion::Identity());
    const RefinedPose refined = refiner.refine(compensated(second_, velocity), guess);
    if (!refined.note.empty()) return std::nullopt;
    return refined.T_odom_lidar;
  }

  Twist velocity_of(const RigidMotion& T_first_second) const {
    return velocity_between(RigidMotion::Identity(), T_first_second, elapsed_);
  }

 private:
  PointCloud compensated(PointCloud scan, const Twist& velocity) const {
    return compensated(std::move(scan), SweepMotion{velocity});
  }
  PointCloud compensated(PointCloud scan, const SweepMotion& motion) const {
    if (compensate_) compensate_sweep(scan, motion, drive_.sweep);
    return scan;
  }

  RegistrationCloud without_ground(const PointCloud& scan) const {
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
  TimeNs first_stamp_, second_stamp_;
  double elapsed_;  // s
  double height_;   // m, of the LiDAR above the ground
  bool compensate_;
  /// The mapper's default options, not the given ones: this finds only a first guess.
  RefinementOptions options_;
};

std::optional<Twist> velocity_by_registration(const ScanPair& scans) {
  if (scans.has_imu()) {
    if (const auto velocity = scans.velocity_by_imu(Twist::Zero())) return velocity;
  }
  std::optional<RigidMotion> T_first_second = scans.find_coarse();
  for (int i = 0; T_first_second && i < kMostRegistrations; ++i) {
    const auto next = scans.refine(*T_first_second);
    const RigidMotion change = next ? T_first_second->inverse() * *next : RigidMotion::Identity();
    T_first_second = next;
    if (change.translation().norm() < kConvergedTranslation &&
        rotation_angle(change.linear()) < kConvergedRotation) {
      break;
    }
  }
  if (!T_first_second) return std::nullopt;
  const Twist velocity = scans.velocity_of(*T_first_second);
  return scans.has_imu() ? scans.velocity_by_imu(velocity).value_or(velocity) : velocity;
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
