#include "fovea/localization/localizer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "fovea/core/angle.h"
#include "fovea/deskew.h"
#include "fovea/drive/scans/sensor_scans.h"
#include "fovea/errors.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/localization/surfaces_in_view.h"
#include "fovea/map/map_surfaces.h"
#include "fovea/mapping/fusion/place_match.h"
#include "fovea/mapping/registration/optimizer.h"
#include "fovea/mapping/registration/pose_covariance.h"

namespace fovea {
namespace {

/// Height above and below what the map has in a column, within which a scan's points count, m; and
/// from a poor guess.
constexpr double kHeight = 0.5, kFarHeight = 2;
/// Fewer points where the map has something are no evidence.
constexpr std::size_t kMinPoints = 300, kMinStanding = 50;
/// A scan is where the prediction has it if this share of the vertical surfaces fits, and if the
/// pose moved little. A place that was searched must fit better.
constexpr PlaceFitOptions kOnSurface{.pair_distance = 0.3f, .on_plane = 0.06f, .alike = 0.8f};
constexpr double kMinHealth = 0.35, kMinHealthFound = 0.5;
constexpr double kMaxCorrection = 1.5, kMaxTurn = 5 * kDegree;  // m, rad
/// After this long without a pose the prediction is searched around, s.
constexpr double kPredicts = 0.5;
/// Streets repeat themselves every few metres: a place is tried from several along the way, and the
/// one that fits best counts, m. From each registration finds what is within about kFarPairs.
constexpr std::array kAlong{0.0, -1.5, 1.5, -3.0, 3.0, -4.5, 4.5};
constexpr double kFarPairs = 2;
/// Places tried a scan, besides the prediction.
constexpr int kTries = 1;
/// What prediction alone loses a scan along a direction that the scene leaves open, standard
/// deviation, m (of turns: at kRotationArm).
constexpr double kOpen = 0.2;
/// Navigation that is kept: so long before the last pose, but no longer than kMostNavigation.
constexpr TimeNs kNavigation = 60 * kNsPerSecond, kMostNavigation = 600 * kNsPerSecond;

}  // namespace

void LocalizerOptions::validate() const {
  if (registration.method == RegistrationMethod::kPointToPoint) {
    throw ConfigError("scans are localized by surfaces", "registration.method",
                      "give gicp or plane");
  }
}

Localizer::Localizer(const MapReader& map, const DriveInfo& drive, LocalizationGuess guess,
                     const LocalizerOptions& options)
    : Localizer(map_surface_source(map), drive, std::move(guess), options) {}

Localizer::Localizer(std::unique_ptr<SurfaceSource> source, const DriveInfo& drive,
                     LocalizationGuess guess, const LocalizerOptions& options)
    : drive_(drive),
      options_(options),
      source_(std::move(source)),
      guess_(std::move(guess)),
      motion_model_(new_motion_model()),
      prior_(*source_, options.registration) {
  options_.validate();
}

MotionModel Localizer::new_motion_model() const {
  return MotionModel(guess_.trajectory ? &*guess_.trajectory : nullptr,
                     {.sweep_rest = from_seconds(drive_.sweep.end_time())});
}

void Localizer::add_navigation(const std::vector<StampedPose>& T_local_lidar) {
  if (!guess_.trajectory) throw std::invalid_argument("the guess has no trajectory to continue");
  if (T_local_lidar.empty()) return;
  Trajectory& navigation = *guess_.trajectory;  // the motion model has its address
  navigation.extend(T_local_lidar);
  const TimeNs newest = T_local_lidar.back().time;
  const TimeNs used = last_ ? std::min(last_->time, newest) : newest;
  const std::size_t dropped =
      navigation.drop_before(std::max(used - kNavigation, newest - kMostNavigation));
  if (dropped > 0 && last_ && last_->time < navigation.poses().front().time) {
    motion_model_ = new_motion_model();  // as at the beginning: the motion since is not known
  }
}

Localization Localizer::localize(const Frame& frame) {
  if (latest_ && frame.stamp <= *latest_) {
    throw std::invalid_argument("scans are localized in the order of time");
  }
  latest_ = frame.stamp;
  Localization result;
  result.index = frame.index;
  result.stamp = frame.stamp;
  MotionPrediction motion = motion_model_.predict(frame.stamp);
  const bool begins = !last_ && !guess_.trajectory && guess_.first;
  if (begins) motion.guesses.front() = {*guess_.first, {}, false, {}};
  const bool placed = last_ || motion.T_local_lidar_navigation || begins;

  Attempt best;
  tracking_ = tracking_ && seconds(frame.stamp - last_->time) < kPredicts;
  if (tracking_ && motion.guesses.front().motion) best = track(frame, motion);
  const bool tracked = best.fits;
  if (!tracked) {
    const Attempt found = search(frame, motion, placed);
    if (found.better_than(best)) best = found;
  }
  result.health = best.health;
  if (best.fits) {
    // Farther from where its motion has it than anything is tracked: not how it moves.
    const MotionGuess& expected = motion.guesses.front();
    const RigidMotion correction =
        expected.T_odom_lidar.inverse() * best.registration.T_target_source;
    const bool jumped = expected.motion && correction.translation().norm() > kMaxCorrection;
    result.found = !tracking_ || best.elsewhere || jumped;
    accept(best, result);
  } else {
    tracking_ = false;
    result.state = placed && !best.covered ? LocalizationState::kOutside : LocalizationState::kLost;
  }
  return result;
}

Localizer::Scan Localizer::prepare(const Frame& frame,
                                   const std::optional<SweepMotion>& motion) const {
  PointCloud scan_lidar = frame.scan;
  const bool moves = options_.compensate_motion && !drive_.sweep_compensated;
  if (motion && moves) compensate_sweep(scan_lidar, *motion, drive_.sweep);
  std::vector<Eigen::Vector3f> near;
  std::copy_if(scan_lidar.position.begin(), scan_lidar.position.end(), std::back_inserter(near),
               [](const Eigen::Vector3f& p) { return p.norm() < float(kLocalizationRange); });
  // The image shows what the first LiDAR sees. It is in its frame.
  if (drive_.lidars.size() > 1) scan_lidar = scans_by_sensor(scan_lidar, drive_.lidars).front();
  return {voxel_thinned(std::move(near), MapSurfaces::kVoxel), RangeImage(scan_lidar.position)};
}

RegistrationCloud Localizer::covered(const Scan& scan, const PriorMap::Target& target,
                                     const RigidMotion& T_target_lidar, double height) const {
  std::vector<Eigen::Vector3f> points = target.plan.covered(scan.points, T_target_lidar, height);
  if (points.size() < kMinPoints) return {};
  return prepare_cloud(std::move(points), options_.registration, MapSurfaces::kVoxel);
}

Localizer::Attempt Localizer::follow(const Scan& scan, const RigidMotion& guess) {
  const PriorMap::Target& target = prior_.around(guess.translation());
  const RigidMotion T_local_target(Eigen::Translation3d{target.center_local});
  const RigidMotion guess_T_target_lidar = T_local_target.inverse() * guess;
  Attempt attempt;
  const RegistrationCloud source = covered(scan, target, guess_T_target_lidar, kHeight);
  attempt.covered = !source.points.empty();
  if (!attempt.covered) return attempt;
  RegistrationResult& result = attempt.registration;
  result = register_clouds(target.cloud, target.index, source, guess_T_target_lidar,
                           options_.registration);
  const PlaceFit fit =
      place_fit(target.cloud, target.index, source, result.T_target_source, kOnSurface);
  attempt.health = fit.overlap * fit.on_plane * (1 - contradiction(scan, target, result));
  result.T_target_source = T_local_target * result.T_target_source;
  const RigidMotion correction = guess.inverse() * result.T_target_source;
  attempt.fits = result.converged && fit.vertical >= kMinStanding && attempt.health >= kMinHealth &&
                 correction.translation().norm() < kMaxCorrection &&
                 rotation_angle(correction.linear()) < kMaxTurn;
  return attempt;
}

double Localizer::contradiction(const Scan& scan, const PriorMap::Target& target,
                                const RegistrationResult& result) const {
  if (source_->is_of_many_drives()) {
    // A city has cars that were parked there on other days. Above the sensor there are few of them:
    // the scan sees through up to a third at the right place, and mostly more at others.
    const SurfacesInView above = surfaces_in_view(target.cloud, scan.image, result.T_target_source,
                                                  /*lowest=*/0);
    if (above.count() >= kMinStanding) return std::pow(above.share_through(), 2);
  }
  return surfaces_in_view(target.cloud, scan.image, result.T_target_source).share_through();
}

Localizer::Attempt Localizer::look_around(const Scan& scan, const RigidMotion& guess) {
  Attempt best;
  for (const double along : kAlong) {
    const RigidMotion shifted = guess * Eigen::Translation3d(along, 0, 0);
    const RigidMotion coarse = register_coarsely(scan, shifted);
    Attempt attempt = follow(scan, coarse);
    attempt.fits = attempt.fits && attempt.registration.degenerate_directions == 0 &&
                   attempt.health >= kMinHealthFound;
    const bool covered = best.covered || attempt.covered;
    if (attempt.better_than(best)) best = std::move(attempt);
    best.covered = covered;
  }
  return best;
}

RigidMotion Localizer::register_coarsely(const Scan& scan, const RigidMotion& guess) {
  const PriorMap::Target& target = prior_.around(guess.translation());
  const RigidMotion T_local_target(Eigen::Translation3d{target.center_local});
  const RigidMotion guess_T_target_lidar = T_local_target.inverse() * guess;
  const RegistrationCloud source = covered(scan, target, guess_T_target_lidar, kFarHeight);
  if (source.points.empty()) return guess;
  RegistrationOptions far = options_.registration;
  far.max_distance = kFarPairs;
  return T_local_target *
         register_clouds(target.cloud, target.index, source, guess_T_target_lidar, far)
             .T_target_source;
}

Localizer::Attempt Localizer::track(const Frame& frame, const MotionPrediction& motion) {
  Attempt best;
  for (const MotionGuess& guess : motion.guesses) {
    Attempt attempt = follow(prepare(frame, guess.motion), guess.T_odom_lidar);
    if (attempt.better_than(best)) best = std::move(attempt);
  }
  return best;
}

Localizer::Attempt Localizer::search(const Frame& frame, const MotionPrediction& motion,
                                     bool placed) {
  Attempt best;
  const auto take = [&](const Scan& scan, const RigidMotion& guess, bool elsewhere) {
    Attempt attempt = look_around(scan, guess);
    attempt.elsewhere = elsewhere;
    best.covered = best.covered || attempt.covered;
    attempt.covered = best.covered;
    if (attempt.better_than(best)) best = std::move(attempt);
    return best.fits;
  };
  const MotionGuess& first = motion.guesses.front();
  if (placed) {
    for (const MotionGuess& guess : motion.guesses) {
      const Scan scan = prepare(frame, guess.motion);
      if (!take(scan, guess.T_odom_lidar, false)) continue;
      return guess.motion ? best : compensated(frame, best);
    }
  }
  const bool covered = best.covered;
  // What it moved like before it was lost says nothing here; navigation does.
  const auto by_navigation =
      std::find_if(motion.guesses.begin(), motion.guesses.end(),
                   [](const MotionGuess& guess) { return guess.by_navigation; });
  const Scan scan =
      prepare(frame, by_navigation == motion.guesses.end() ? std::nullopt : by_navigation->motion);
  Eigen::Vector3d near = first.T_odom_lidar.translation();
  candidates_.add(placed ? source_->new_frames_near(near) : source_->new_frames());
  if (!placed && !candidates_.empty()) near = candidates_.first().translation();
  for (int i = 0; i < kTries && !best.fits && !candidates_.empty(); ++i) {
    take(scan, candidates_.next(near), true);
  }
  best.covered = covered;
  return best;
}

Localizer::Attempt Localizer::compensated(const Frame& frame, const Attempt& found) {
  if (!tracking_) return found;  // it has moved in whatever ways since
  const RigidMotion& T_local_lidar = found.registration.T_target_source;
  const SweepMotion motion{
      velocity_between(last_->T_local_body, T_local_lidar, seconds(frame.stamp - last_->time))};
  const Attempt attempt = follow(prepare(frame, motion), T_local_lidar);
  return attempt.better_than(found) ? attempt : found;
}

void Localizer::accept(const Attempt& attempt, Localization& result) {
  const RegistrationResult& registration = attempt.registration;
  result.state = LocalizationState::kLocalized;
  result.T_local_lidar = registration.T_target_source;
  result.degenerate_directions = registration.degenerate_directions;
  open_frames_ = registration.degenerate_directions > 0 ? open_frames_ + 1 : 0;
  result.covariance = pose_covariance(registration, kOpen * open_frames_);
  if (result.found) motion_model_ = new_motion_model();
  motion_model_.update(*result.stamp, result.T_local_lidar);
  last_ = StampedPose{*result.stamp, result.T_local_lidar};
  tracking_ = true;
  candidates_.restart();
}

}  // namespace fovea
