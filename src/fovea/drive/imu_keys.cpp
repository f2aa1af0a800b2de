#include "fovea/drive/imu_keys.h"

namespace fovea {

constexpr auto names_of(ForceUnit) {
  return std::array{EnumName<ForceUnit>{ForceUnit::kAuto, "auto"},
                    EnumName<ForceUnit>{ForceUnit::kMetric, "m/s2"},
                    EnumName<ForceUnit>{ForceUnit::kGravity, "g"}};
}

constexpr auto names_of(RateUnit) {
  return std::array{EnumName<RateUnit>{RateUnit::kRadians, "rad/s"},
                    EnumName<RateUnit>{RateUnit::kDegrees, "deg/s"}};
}

void ImuKeys::visit(SettingVisitor& visit) {
  T_lidar_imu_.visit(visit);
  visit("imu.delay", imu_.delay);
  visit("imu.acceleration_unit", imu_.force_unit);
  visit("imu.rate_unit", imu_.rate_unit);
  visit("imu.gyroscope_noise_density", imu_.noise.gyroscope_noise_density);
  visit("imu.gyroscope_random_walk", imu_.noise.gyroscope_random_walk);
  visit("imu.accelerometer_noise_density", imu_.noise.accelerometer_noise_density);
  visit("imu.accelerometer_random_walk", imu_.noise.accelerometer_random_walk);
}

std::optional<ImuDescription> ImuKeys::imu() const {
  check_key("imu.delay", imu_.delay, -1, 1);
  const ImuNoise& noise = imu_.noise;
  constexpr double kLeast = 1e-8;
  check_key("imu.gyroscope_noise_density", noise.gyroscope_noise_density, kLeast, 1);
  check_key("imu.gyroscope_random_walk", noise.gyroscope_random_walk, kLeast, 1);
  check_key("imu.accelerometer_noise_density", noise.accelerometer_noise_density, kLeast, 10);
  check_key("imu.accelerometer_random_walk", noise.accelerometer_random_walk, kLeast, 10);
  const auto T_lidar_imu = T_lidar_imu_.motion();
  if (!T_lidar_imu) return std::nullopt;
  check_lever(T_lidar_imu_.forward.key, T_lidar_imu->translation());
  ImuDescription imu = imu_;
  imu.T_lidar_imu = *T_lidar_imu;
  return imu;
}

}  // namespace fovea
