// drive.toml: what the sensors of a drive are and where they sit (docs/drives.md).
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/angle.h"
#include "fovea/drive/scans/scan_format.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/geometry/imu_data.h"
#include "fovea/geometry/lens.h"
#include "fovea/geometry/sensor_profile.h"
#include "fovea/rigid_motion.h"

namespace fovea {

struct CameraDescription {
  std::string name;
  std::filesystem::path folder;  ///< of its images, below the drive's
  int index = 0;                 ///< the number that commands and maps know it by, 0 to 9
  LensCamera optics;
  RigidMotion T_cam_lidar = RigidMotion::Identity();
  double max_field_of_view =
      100 * kDegree;           ///< rad, of the rectified image; not of pinhole cameras
  std::filesystem::path mask;  ///< a picture, below the drive's folder; empty: none
  double delay = 0;  ///< s from an image's stamp (or its scan's, if it has none) to its exposure
  /// s from the stamps of scans to those of their images, about; absent: the median of the drive.
  std::optional<double> stamp_delay;
};

/// What drive.toml states of SweepTiming.
struct SweepDescription {
  std::optional<double> period;  ///< s
  std::optional<SweepDirection> direction;
  std::optional<double> start_azimuth;  ///< rad
  std::optional<double> stamp_phase;
};

struct LidarDescription {
  std::string name;              ///< of its table; empty: the drive has one LiDAR
  std::filesystem::path folder;  ///< of its scans, below the drive's
  StatedScanFormat scan_format;
  bool sweep_compensated = false;
  SweepDescription sweep;
  RigidMotion T_lidar_sensor = RigidMotion::Identity();

  /// Its table in drive.toml: "lidar" or "lidar.NAME".
  std::string table() const { return name.empty() ? "lidar" : "lidar." + name; }
};

enum class ForceUnit { kAuto, kMetric, kGravity };
enum class RateUnit { kRadians, kDegrees };

/// What drive.toml states of the rates and accelerations of imu.csv.
struct ImuDescription {
  RigidMotion T_lidar_imu = RigidMotion::Identity();
  ImuNoise noise;
  double delay = 0;  ///< s from the stamp of a record to its measurement
  ForceUnit force_unit = ForceUnit::kAuto;
  RateUnit rate_unit = RateUnit::kRadians;
};

/// Of wheels.csv. The body's x axis points forward.
struct WheelDescription {
  RigidMotion T_lidar_body = RigidMotion::Identity();
  double sigma = 0.1;  ///< m/s, standard deviation of a speed
};

/// Of cameras: Camera::index.
inline constexpr int kMaxCameraIndex = 9;

struct DriveDescription {
  LidarDescription lidar;  ///< the first one: its frame and its stamps are the drive's
  std::vector<LidarDescription> further_lidars;  ///< by name
  double image_tolerance = 0.06;                 ///< s, between an image and its sweep's middle
  /// Body: what poses.csv and the attitudes of gnss.csv are of.
  RigidMotion T_body_lidar = RigidMotion::Identity();
  RigidMotion T_body_imu = RigidMotion::Identity();        ///< of imu.csv's orientations
  Eigen::Vector3d antenna_body = Eigen::Vector3d::Zero();  ///< of gnss.csv's positions
  CoordinateReference coordinates;                         ///< of gnss.csv's positions
  std::optional<ImuDescription> imu;  ///< absent: imu.csv has orientations only
  WheelDescription wheels;
  std::vector<CameraDescription> cameras;  ///< by index; may be empty
};

/// Rejects a missing `version`, and one that this program does not read.
/// @throws ConfigError  whose place is the key
void check_drive_version(const std::optional<int>& version);

/// Reads drive.toml. InputError if it cannot be read; ConfigError that names file and key (and
/// line, where the key is there) for a syntax error, an unknown or missing key, a wrong type, or
/// values that are no calibration.
DriveDescription read_drive_description(const std::filesystem::path& file);

/// The same of a text; `name` stands for the file in errors.
DriveDescription parse_drive_description(std::string_view text, std::string_view name);

}  // namespace fovea
