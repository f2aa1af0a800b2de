// Intrinsics of a camera from the calibration file of another program.
#pragma once

#include <filesystem>
#include <string>

#include "fovea/geometry/lens.h"

namespace fovea {

/// Reads the YAML file of ROS's camera_calibration, Kalibr's camchain, or the JSON of
/// SensorsCalibration; the content determines which.
/// @param camera  its name in a camchain ("cam0"); empty: the only one
/// InputError that names the file for other content, for several cameras without a name, and for
/// camera and distortion models that are not read (omni, eucm, ds, fov), by their names.
LensCamera read_calibration_file(const std::filesystem::path& file, const std::string& camera);

}  // namespace fovea
