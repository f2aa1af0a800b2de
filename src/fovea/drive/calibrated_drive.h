// Calibrated drives: a folder whose drive.toml names another drive and corrects its calibration
// (docs/drives.md). The frames stay in the other drive's folder.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "fovea/drive/drive_correction.h"
#include "fovea/drive/frame_source.h"

namespace fovea {

/// Whether a file can be read and is the drive.toml of a calibrated drive.
bool is_calibrated_drive_file(const std::filesystem::path& file);

/// Opens the drive that `folder` corrects. The calibration is the corrected one, the path that of
/// `folder`.
/// @throws InputError   if there is no such drive, or if calibrated drives name each other in a
///                      circle or in a chain of over 8
/// @throws ConfigError  for a fault of the file, and for a camera or an IMU that the drive lacks
std::unique_ptr<FrameSource> open_calibrated_drive(const std::filesystem::path& folder,
                                                   const DriveOptions& options);

/// The folder that has the files of a drive, such as its truth: that of the drive which a
/// calibrated drive corrects; of any other drive its own.
/// @throws Error  as open_calibrated_drive()
std::filesystem::path recorded_folder(const std::filesystem::path& drive);

/// The folders that the calibrated drive `drive` depends on: of each drive that it corrects,
/// directly or through another one. Empty for any other drive.
/// @throws Error  as open_calibrated_drive()
std::vector<std::filesystem::path> corrected_folders(const std::filesystem::path& drive);

/// Before the correction is known: throws the errors of write_calibrated_drive() that do not depend
/// on it.
void check_calibrated_drive(const std::filesystem::path& folder, const std::filesystem::path& drive,
                            bool force);

/// Makes `folder`, if it is not there, and writes its drive.toml in one step.
/// @param drive  folder of the drive to correct, which may be a calibrated one. The file states it
///               relative to `folder`.
/// @param force  replaces the drive.toml of a calibrated drive
/// @throws InputError   if `folder` has a drive.toml that may not be replaced or is the folder of
///                      another drive, or if `drive` is missing or depends on `folder`
/// @throws ConfigError  if the correction is no calibration of a vehicle
/// @throws OutputError  if the file cannot be written
void write_calibrated_drive(const std::filesystem::path& folder, const std::filesystem::path& drive,
                            const DriveCorrection& correction, bool force = false);

}  // namespace fovea
