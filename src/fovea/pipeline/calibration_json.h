// Estimated calibrations as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "fovea/pipeline/drive_calibration.h"

namespace fovea {

/// One object a camera; null for values that are not observable.
/// @param applied  whether the map was made under the corrections
nlohmann::ordered_json to_json(const std::vector<CameraCalibration>& cameras, bool applied);

/// Null without an IMU.
nlohmann::ordered_json to_json(const std::optional<ImuHandEye>& imu);

}  // namespace fovea
