// The results of fovea calibrate in words, for the terminal and for the page.
#pragma once

#include <string>

#include "fovea/mapping/calibration/calibration_estimate.h"
#include "fovea/mapping/calibration/imu_hand_eye.h"
#include "fovea/mapping/calibration/lens_check.h"

namespace fovea::app {

/// "rotation about x (right)", "points forward", "delay of the images".
/// @param parameter  0 to kCalibrationSize - 1, by CalibrationParameter
std::string calibration_parameter_name(int parameter);

/// The motion or the scene that makes a value observable, as a command. Empty if it is observable,
/// or if camera and LiDAR disagree.
std::string missing_evidence(const CalibrationEstimate& estimate, int parameter);

/// Whether the edges fit focal length and distortion, as a sentence.
std::string lens_text(const LensCheck& lens);

/// Why IMU and LiDAR disagree and what to check, as a sentence. Empty if they agree.
std::string imu_disagreement(const ImuHandEye& estimate);

}  // namespace fovea::app
