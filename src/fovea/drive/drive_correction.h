// The drive.toml of a calibrated drive: another drive with a corrected calibration
// (docs/drives.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/settings.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// The parts of a calibration that replace those of a drive.
struct DriveCorrection {
  struct CorrectedCamera {
    int camera = 0;  ///< its number in the drive (Camera::index)
    RigidMotion T_cam_lidar = RigidMotion::Identity();
    double added_delay = 0;  ///< s, added to Camera::image_delay
  };
  struct CorrectedImu {
    RigidMotion T_lidar_imu = RigidMotion::Identity();
    double added_delay = 0;  ///< s, added to the times of the samples
  };
  std::vector<CorrectedCamera> cameras;  ///< a camera at most once
  std::optional<CorrectedImu> imu;
};

/// What the file states.
struct CalibratedDrive {
  std::filesystem::path drive;  ///< folder of the other drive, relative to that of the file
  DriveCorrection correction;
};

/// Whether a drive.toml is that of a calibrated drive: it has the table [calibrated].
bool is_calibrated_drive(const SettingsDocument& document);

/// Opens no file.
/// @throws ConfigError  naming file, line and key: an unknown or missing key, a wrong type, or
///                      values that are no calibration
CalibratedDrive parse_calibrated_drive(const SettingsDocument& document);

/// The file's text. Its numbers are read back without loss.
/// @throws InputError  for a path that is no UTF-8: TOML has no other texts
std::string calibrated_drive_text(const CalibratedDrive& drive);

}  // namespace fovea
