// Where tf says that a sensor is.
#pragma once

#include <string>

#include "fovea/drive/recordings/bag_index.h"
#include "fovea/geometry/quaternion_motion.h"

namespace fovea {

/// T_lidar_sensor. InputError if tf does not state it, or if something between both moves.
/// @param topic  of the sensor, for errors
QuaternionMotion place_on_vehicle(const BagIndex& index, const std::string& lidar_frame,
                                  const std::string& frame, const std::string& topic);

}  // namespace fovea
