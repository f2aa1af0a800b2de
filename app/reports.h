// Figures for people and for programs (the contract of --report).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fovea/core/messages.h"
#include "fovea/core/output_file.h"
#include "fovea/pipeline/drive_calibration.h"

namespace fovea::app {

/// Messages about the calibration of each camera and of the IMU: warnings about what is wrong and
/// stays so.
/// @param applied  whether the corrections are in use; false: by the check of a drive
Messages calibration_messages(const DriveCalibration& calibration, bool applied);

/// Writes indented JSON and commits the file.
void write_json(OutputFile& file, const nlohmann::ordered_json& json);

}  // namespace fovea::app
