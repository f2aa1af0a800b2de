// The estimated values of a calibration as tables, for calibration_page().
#pragma once

#include <string>

#include "fovea/pipeline/drive_calibration.h"

namespace fovea::app {

/// A camera's corrections, what its images lack, its lens, and the corrected calibration to copy.
/// @param given      the camera of the drive
/// @param corrected  what the output states for it
std::string camera_values(const CameraCalibration& found, const Camera& given,
                          const DriveCorrection& corrected);

/// The same for the IMU.
std::string imu_values(const ImuHandEye& found, const DriveCorrection& corrected);

}  // namespace fovea::app
