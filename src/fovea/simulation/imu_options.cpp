#include "fovea/simulation/imu_options.h"

#include "fovea/simulation/option_checks.h"

namespace fovea {

void check(const ImuOptions& imu, const WheelOptions& wheels) {
  check_range("imu.rate", imu.rate, 0, 2000, "Hz");
  if (imu.rate > 0) check_range("imu.rate", imu.rate, 10, 2000, "Hz");
  check_range("imu.forward", imu.forward, -10, 10, "m");
  check_range("imu.left", imu.left, -10, 10, "m");
  check_range("imu.up", imu.up, -10, 10, "m");
  check_degrees("imu.roll", imu.roll, -180, 180);
  check_degrees("imu.pitch", imu.pitch, -180, 180);
  check_degrees("imu.yaw", imu.yaw, -180, 180);
  check_degrees("imu.gyroscope_noise", imu.gyroscope_noise, 0, 10);
  check_range("imu.gyroscope_walk", imu.gyroscope_walk, 0, 0.1, "rad/s^2 per root Hz");
  check_degrees("imu.gyroscope_bias", imu.gyroscope_bias, 0, 20);
  check_range("imu.accelerometer_noise", imu.accelerometer_noise, 0, 1, "m/s^2 per root Hz");
  check_range("imu.accelerometer_walk", imu.accelerometer_walk, 0, 0.1, "m/s^3 per root Hz");
  check_range("imu.accelerometer_bias", imu.accelerometer_bias, 0, 2, "m/s^2");
  check_degrees("imu.gyroscope_range", imu.gyroscope_range, 0, 10'000);
  check_range("imu.accelerometer_range", imu.accelerometer_range, 0, 1000, "m/s^2");
  check_range("imu.time_offset", imu.time_offset, -1, 1, "s");
  check_range("imu.gap_at", imu.gap_at, 0, 1e5, "s");
  check_range("imu.gap_duration", imu.gap_duration, 0, 1e5, "s");
  check_range("imu.flipped_axis", imu.flipped_axis, 0, 3);
  check_degrees("imu.rotation_error_x", imu.rotation_error.x(), -20, 20);
  check_degrees("imu.rotation_error_y", imu.rotation_error.y(), -20, 20);
  check_degrees("imu.rotation_error_z", imu.rotation_error.z(), -20, 20);
  check_range("wheels.rate", wheels.rate, 0, 1000, "Hz");
  check_range("wheels.noise", wheels.noise, 0, 10, "m/s");
  check_range("wheels.scale", wheels.scale, 0.5, 2);
}

void check_kitti_format(const ImuOptions& imu, const WheelOptions& wheels) {
  if (imu.rate > 0) reject("KITTI's format has no IMU", "imu.rate", "use --format generic");
  if (wheels.rate > 0) {
    reject("KITTI's format has no wheels", "wheels.rate", "use --format generic");
  }
}

void scale_errors(ImuOptions& imu, WheelOptions& wheels, double factor) {
  for (double* error :
       {&imu.gyroscope_noise, &imu.gyroscope_walk, &imu.gyroscope_bias, &imu.accelerometer_noise,
        &imu.accelerometer_walk, &imu.accelerometer_bias, &wheels.noise}) {
    *error *= factor;
  }
}

void visit_imu(SettingVisitor& visit, ImuOptions& imu) {
  visit("imu.rate", imu.rate);
  visit("imu.forward", imu.forward);
  visit("imu.left", imu.left);
  visit("imu.up", imu.up);
  visit("imu.roll", Degrees{imu.roll});
  visit("imu.pitch", Degrees{imu.pitch});
  visit("imu.yaw", Degrees{imu.yaw});
  visit("imu.gyroscope_noise", Degrees{imu.gyroscope_noise});
  visit("imu.gyroscope_walk", imu.gyroscope_walk);
  visit("imu.gyroscope_bias", Degrees{imu.gyroscope_bias});
  visit("imu.accelerometer_noise", imu.accelerometer_noise);
  visit("imu.accelerometer_walk", imu.accelerometer_walk);
  visit("imu.accelerometer_bias", imu.accelerometer_bias);
  visit("imu.gyroscope_range", Degrees{imu.gyroscope_range});
  visit("imu.accelerometer_range", imu.accelerometer_range);
  visit("imu.time_offset", imu.time_offset);
  visit("imu.gap_at", imu.gap_at);
  visit("imu.gap_duration", imu.gap_duration);
  visit("imu.in_degrees", imu.in_degrees);
  visit("imu.in_g", imu.in_g);
  visit("imu.flipped_axis", imu.flipped_axis);
  visit("imu.rotation_error_x", Degrees{imu.rotation_error.x()});
  visit("imu.rotation_error_y", Degrees{imu.rotation_error.y()});
  visit("imu.rotation_error_z", Degrees{imu.rotation_error.z()});
}

void visit_wheels(SettingVisitor& visit, WheelOptions& wheels) {
  visit("wheels.rate", wheels.rate);
  visit("wheels.noise", wheels.noise);
  visit("wheels.scale", wheels.scale);
}

}  // namespace fovea
