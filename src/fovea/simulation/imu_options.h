// IMU and wheels of a simulated vehicle.
#pragma once

#include <Eigen/Core>

#include "fovea/core/angle.h"
#include "fovea/core/settings.h"
#include "fovea/platform.h"

namespace fovea {

/// An IMU; imu.csv. The usual errors are those of a consumer's unit.
struct ImuOptions {
  double rate = 0;  ///< Hz; 0: there is none
  /// Place and mount against the (upright) first LiDAR: m; rad, Rz(yaw) * Ry(pitch) * Rx(roll).
  double forward = -0.1, left = 0.05, up = -0.12;
  double roll = 0, pitch = 0, yaw = 0;
  double gyroscope_noise = 0.014 * kDegree;  ///< rad/s per root Hz
  double gyroscope_walk = 2e-5;              ///< rad/s^2 per root Hz
  double gyroscope_bias = 0.3 * kDegree;     ///< rad/s, standard deviation
  double accelerometer_noise = 2e-3;         ///< m/s^2 per root Hz
  double accelerometer_walk = 2e-4;          ///< m/s^3 per root Hz
  double accelerometer_bias = 0.1;           ///< m/s^2, standard deviation
  double gyroscope_range = 0;                ///< rad/s; 0: no limit
  double accelerometer_range = 0;            ///< m/s^2; 0: no limit
  // Planted faults: what drive.toml does not say.
  double time_offset = 0;   ///< s, stamps are late by this
  double gap_at = 0;        ///< s, from frame 0's stamp
  double gap_duration = 0;  ///< s without records
  bool in_degrees = false;  ///< rates are in degrees a second
  bool in_g = false;        ///< accelerations are in units of gravity
  int flipped_axis = 0;     ///< 1, 2 or 3: this axis points the other way; 0: none
  Eigen::Vector3d rotation_error = Eigen::Vector3d::Zero();  ///< rad, of the mount
};

/// A sensor of the wheels' speed; wheels.csv.
struct WheelOptions {
  double rate = 0;      ///< Hz; 0: there is none
  double noise = 0.03;  ///< m/s
  double scale = 1;     ///< measured speed per true one
};

/// ConfigError that names the key.
void check(const ImuOptions& imu, const WheelOptions& wheels);

/// ConfigError for what KITTI's format has no place for.
void check_kitti_format(const ImuOptions& imu, const WheelOptions& wheels);

/// Multiplies all errors but the planted faults.
void scale_errors(ImuOptions& imu, WheelOptions& wheels, double factor);

/// Calls `visit(key, reference)` for every key.
void visit_imu(SettingVisitor& visit, ImuOptions& imu);
void visit_wheels(SettingVisitor& visit, WheelOptions& wheels);

}  // namespace fovea
