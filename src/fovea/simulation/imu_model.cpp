#include "fovea/simulation/imu_model.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/random.h"
#include "fovea/simulation/drive_texts.h"

namespace fovea {
namespace {

constexpr double kGravity = 9.81;    // m/s^2, as of the GPS/INS
constexpr double kHalfStep = 0.001;  // s, of the derivatives
enum Kind : std::uint64_t { kBias = 0x696d7500, kWalk, kWhite, kWheel };

Eigen::Vector3d normal_vector(Random& random, double deviation) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return deviation * Eigen::Vector3d(x, y, z);
}

Eigen::Vector3d saturated(const Eigen::Vector3d& value, double limit) {
  return limit > 0 ? Eigen::Vector3d(value.cwiseMax(-limit).cwiseMin(limit)) : value;
}

/// Times of a sensor at a rate, from before the first sweep to after the last one (s from frame
/// 0's stamp).
std::vector<double> sample_times(double rate, const SimulationOptions& options) {
  const double period = options.lidar.period;
  const double begin = -period, end = period * options.frames;
  std::vector<double> times;
  for (double i = std::ceil(begin * rate); i <= end * rate; ++i) times.push_back(i / rate);
  return times;
}

TimeNs stamp_at(double time, const SimulationOptions& options) {
  return stamp_of(0, options) + from_seconds(time);
}

/// Without errors.
ImuRecord true_record(const VehicleMotion& motion, const RigidMotion& T_vehicle_imu, double time) {
  const auto pose = [&](double at) -> RigidMotion {
    return motion.T_world_vehicle(at) * T_vehicle_imu;
  };
  const RigidMotion before = pose(time - kHalfStep), now = pose(time),
                    after = pose(time + kHalfStep);
  const Eigen::Vector3d acceleration =
      (after.translation() - 2 * now.translation() + before.translation()) /
      (kHalfStep * kHalfStep);
  ImuRecord record;
  record.force = now.linear().transpose() * (acceleration + kGravity * Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd turn(before.linear().transpose() * after.linear());
  record.rate = turn.angle() * turn.axis() / (2 * kHalfStep);
  return record;
}

}  // namespace

std::vector<ImuRecord> simulate_imu(const VehicleMotion& motion, const Rig& rig,
                                    const SimulationOptions& options) {
  const ImuOptions& imu = options.imu;
  if (imu.rate == 0) return {};
  const auto stream = static_cast<std::uint64_t>(options.pass_seed());
  const RigidMotion T_vehicle_imu = rig.T_vehicle_lidar * rig.T_lidar_imu;
  const double step = 1 / imu.rate;
  Random of_bias = Random::of_item(stream, kBias, 0);
  Eigen::Vector3d rate_bias = normal_vector(of_bias, imu.gyroscope_bias),
                  force_bias = normal_vector(of_bias, imu.accelerometer_bias);
  std::vector<ImuRecord> records;
  const std::vector<double> times = sample_times(imu.rate, options);
  for (std::size_t i = 0; i < times.size(); ++i) {
    Random of_walk = Random::of_item(stream, kWalk, i),
           of_white = Random::of_item(stream, kWhite, i);
    rate_bias += normal_vector(of_walk, imu.gyroscope_walk * std::sqrt(step));
    force_bias += normal_vector(of_walk, imu.accelerometer_walk * std::sqrt(step));
    if (times[i] >= imu.gap_at && times[i] < imu.gap_at + imu.gap_duration) continue;
    ImuRecord record = true_record(motion, T_vehicle_imu, times[i]);
    record.rate += rate_bias + normal_vector(of_white, imu.gyroscope_noise / std::sqrt(step));
    record.force += force_bias + normal_vector(of_white, imu.accelerometer_noise / std::sqrt(step));
    record.rate = saturated(record.rate, imu.gyroscope_range);
    record.force = saturated(record.force, imu.accelerometer_range);
    if (imu.flipped_axis > 0) {
      record.rate[imu.flipped_axis - 1] *= -1;
      record.force[imu.flipped_axis - 1] *= -1;
    }
    if (imu.in_degrees) record.rate /= kDegree;
    if (imu.in_g) record.force /= kGravity;
    record.time = stamp_at(times[i] + imu.time_offset, options);
    records.push_back(record);
  }
  return records;
}

std::vector<WheelRecord> simulate_wheels(const VehicleMotion& motion, const Rig& rig,
                                         const SimulationOptions& options) {
  const WheelOptions& wheels = options.wheels;
  if (wheels.rate == 0) return {};
  const RigidMotion T_vehicle_body = rig.T_vehicle_lidar * rig.T_imu_lidar.inverse();
  const auto stream = static_cast<std::uint64_t>(options.pass_seed());
  std::vector<WheelRecord> records;
  const std::vector<double> times = sample_times(wheels.rate, options);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto pose = [&](double at) -> RigidMotion {
      return motion.T_world_vehicle(at) * T_vehicle_body;
    };
    const Eigen::Vector3d velocity =
        (pose(times[i] + kHalfStep).translation() - pose(times[i] - kHalfStep).translation()) /
        (2 * kHalfStep);
    Random random = Random::of_item(stream, kWheel, i);
    const double forward = (pose(times[i]).linear().transpose() * velocity).x();
    records.push_back(
        {stamp_at(times[i], options), wheels.scale * forward + wheels.noise * random.normal()});
  }
  return records;
}

}  // namespace fovea
