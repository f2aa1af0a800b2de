#include "fovea/drive/recordings/place_on_vehicle.h"

#include <fmt/format.h>

#include "fovea/errors.h"

namespace fovea {

QuaternionMotion place_on_vehicle(const BagIndex& index, const std::string& lidar_frame,
                                  const std::string& frame, const std::string& topic) {
  const auto T_lidar_sensor = index.transforms.fixed(lidar_frame, frame);
  if (!T_lidar_sensor) {
    throw InputError(fmt::format("tf does not say where frame '{}' is in '{}'", frame, lidar_frame),
                     topic, "record /tf_static, too");
  }
  if (const auto moving = index.transforms.moving(lidar_frame, frame)) {
    throw InputError(
        fmt::format("frame '{}' moves between '{}' and '{}'", *moving, lidar_frame, frame), topic,
        "a sensor must sit still on the vehicle");
  }
  return *T_lidar_sensor;
}

}  // namespace fovea
