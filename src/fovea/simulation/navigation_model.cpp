#include "fovea/simulation/navigation_model.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "fovea/core/random.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/simulation/drive_texts.h"
#include "fovea/simulation/navigation_errors.h"

namespace fovea {
namespace {

constexpr double kGravity = 9.81;    // m/s^2
constexpr double kHalfStep = 0.005;  // s, of the derivatives: errors below 1e-4 of their size
constexpr double kVelocityAccuracy = 0.02;  // m/s, what a good unit reports

/// The first and second derivatives of a motion.
struct Derivatives {
  Eigen::Vector3d velocity, acceleration;  ///< in the frame that the poses are in
  Eigen::Vector3d rate_body;               ///< rad/s
};

Derivatives differentiate(const RigidMotion& before, const RigidMotion& now,
                          const RigidMotion& after) {
  Derivatives d;
  d.velocity = (after.translation() - before.translation()) / (2 * kHalfStep);
  d.acceleration = (after.translation() - 2 * now.translation() + before.translation()) /
                   (kHalfStep * kHalfStep);
  RigidMotion turn = RigidMotion::Identity();
  turn.linear() = before.linear().transpose() * after.linear();
  d.rate_body = log_se3(turn).head<3>() / (2 * kHalfStep);
  return d;
}

/// rad in [-pi, pi]
double wrap(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

std::string join(std::initializer_list<Eigen::Vector3d> vectors) {
  std::string text;
  for (const Eigen::Vector3d& v : vectors) {
    text += fmt::format(" {:.15g} {:.15g} {:.15g}", v.x(), v.y(), v.z());
  }
  return text;
}

NavigationRecord record_of(TimeNs time, const LocalTangentPlane& local,
                           const RigidMotion& T_local_imu, const Derivatives& derivatives,
                           const NavigationError& error) {
  // Everything is said in the east-north-up frame of the place that the unit believes to be at.
  const GeodeticPoint place = local.to_geodetic(T_local_imu.translation() + error.position);
  const Eigen::Matrix3d R_enu_local = local.T_local_enu(place).linear().transpose();
  const Eigen::Matrix3d R_enu_imu = R_enu_local * T_local_imu.linear();
  const double roll = std::atan2(R_enu_imu(2, 1), R_enu_imu(2, 2)) + error.angles.x();
  const double pitch = -std::asin(R_enu_imu(2, 0)) + error.angles.y();
  const double heading = std::atan2(R_enu_imu(1, 0), R_enu_imu(0, 0));
  const double yaw = heading + error.angles.z();
  NavigationRecord record{
      .time = time,
      .place = place,
      .roll = wrap(roll),
      .pitch = wrap(pitch),
      .yaw = wrap(yaw),
      .accuracy = error.outage ? std::numeric_limits<double>::infinity() : error.accuracy,
      .velocity = {},
      .text = {}};

  // Level: forward along the heading, left, up.
  const Eigen::Matrix3d R_level_enu =
      Eigen::AngleAxisd(-heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d velocity_enu = R_enu_local * derivatives.velocity + error.velocity;
  const Eigen::Vector3d velocity_level = R_level_enu * velocity_enu;
  const Eigen::Vector3d force_enu =
      R_enu_local * derivatives.acceleration + kGravity * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d rate_body = derivatives.rate_body + error.rate;
  const Eigen::Vector3d rate_enu = R_enu_imu * rate_body;

  record.velocity.head<3>() = rate_body;
  record.velocity.tail<3>() = Eigen::AngleAxisd(-roll, Eigen::Vector3d::UnitX()) *
                              Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()) * velocity_level;

  constexpr int kLocked = 4, kDifferential = 4, kNone = 0, kSatellites = 8;
  const int mode = error.outage ? kNone : kDifferential;
  record.text = fmt::format("{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.15g} {:.15g}",
                            place.latitude, place.longitude, place.altitude, record.roll,
                            record.pitch, record.yaw, velocity_enu.y(), velocity_enu.x()) +
                join({velocity_level, R_enu_imu.transpose() * force_enu, R_level_enu * force_enu,
                      rate_body, R_level_enu * rate_enu}) +
                fmt::format(" {:.15g} {:.15g} {} {} {} {} {}\n", error.accuracy, kVelocityAccuracy,
                            kLocked, error.outage ? 0 : kSatellites, mode, mode, kNone);
  return record;
}

}  // namespace

std::string navigation_format_text() {
  return "lat:          latitude of the unit (deg)\n"
         "lon:          longitude of the unit (deg)\n"
         "alt:          altitude of the unit (m)\n"
         "roll:         roll angle (rad), 0 = level, positive = left side up\n"
         "pitch:        pitch angle (rad), 0 = level, positive = front down\n"
         "yaw:          heading (rad), 0 = east, positive = counter clockwise\n"
         "vn, ve:       velocity towards north, towards east (m/s)\n"
         "vf, vl, vu:   velocity forward, leftward, upward of the level frame (m/s)\n"
         "ax, ay, az:   acceleration with gravity along the unit's axes (m/s^2)\n"
         "af, al, au:   the same in the level frame (m/s^2)\n"
         "wx, wy, wz:   angular rate around the unit's axes (rad/s)\n"
         "wf, wl, wu:   the same around those of the level frame (rad/s)\n"
         "pos_accuracy: accuracy of the position (m)\n"
         "vel_accuracy: accuracy of the velocity (m/s)\n"
         "navstat:      navigation status, 4 = locked\n"
         "numsats:      number of satellites\n"
         "posmode, velmode, orimode: modes of position, velocity, orientation; 0 = none\n";
}

std::vector<NavigationRecord> simulate_navigation(const VehicleMotion& motion, const Rig& rig,
                                                  const RigidMotion& T_world_local,
                                                  const SimulationOptions& options) {
  std::vector<TimeNs> stamps;
  std::vector<double> times;
  for (int frame = 0; frame < options.frames; ++frame) {
    constexpr std::uint64_t kKind = 0x64656c6179;
    Random random = Random::of_item(static_cast<std::uint64_t>(options.pass_seed()), kKind,
                                    static_cast<std::uint64_t>(frame));
    const double delay = random.uniform(options.navigation.min_delay, options.navigation.max_delay);
    stamps.push_back(stamp_of(frame, options) + from_seconds(delay));
    // The nanosecond that is written is when the record was taken.
    times.push_back(seconds(stamps.back() - stamp_of(0, options)));
  }
  const auto errors = navigation_errors(times, options.navigation, options.pass_seed());
  const LocalTangentPlane local(options.navigation.origin);
  const RigidMotion T_local_world = T_world_local.inverse();
  const RigidMotion T_vehicle_imu = rig.T_vehicle_lidar * rig.T_imu_lidar.inverse();
  const auto T_local_imu = [&](double time) -> RigidMotion {
    return T_local_world * motion.T_world_vehicle(time) * T_vehicle_imu;
  };
  std::vector<NavigationRecord> records;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const RigidMotion now = T_local_imu(times[i]);
    const Derivatives derivatives =
        differentiate(T_local_imu(times[i] - kHalfStep), now, T_local_imu(times[i] + kHalfStep));
    records.push_back(record_of(stamps[i], local, now, derivatives, errors[i]));
  }
  return records;
}

}  // namespace fovea
