// Private to api/, and to the Python module.
#pragma once

#include "fovea/drive.h"
#include "fovea/drive/writers/drive_writer.h"

namespace fovea {

/// @throws std::invalid_argument  for a camera that is none
RecordedCamera recorded_camera(const DriveCamera& camera);

}  // namespace fovea
