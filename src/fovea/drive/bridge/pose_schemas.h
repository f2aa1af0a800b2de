// Definitions of the messages that Fovea publishes, as `ros2msg` and `ros1msg`: the type, and the
// types in it. From the packages nav_msgs, tf2_msgs, std_msgs and geometry_msgs, without comments.
#pragma once

#include <string>

namespace fovea::bridge {

std::string odometry_schema(bool is_ros1);
std::string transforms_schema(bool is_ros1);
std::string string_schema();

}  // namespace fovea::bridge
