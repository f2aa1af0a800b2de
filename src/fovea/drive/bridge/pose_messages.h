// Poses as messages of ROS.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fovea/drive/bridge/bridge_messages.h"
#include "fovea/drive/bridge/published_pose.h"

namespace fovea::bridge {

inline constexpr std::string_view kJsonEncoding = "json";

/// The topics of Fovea's own poses, which it does not read back.
inline constexpr std::string_view kOdometryTopic = "/fovea/odometry";
inline constexpr std::string_view kStateTopic = "/fovea/state";
inline constexpr std::string_view kTransformTopic = "/tf";

/// The channels of poses: nav_msgs/Odometry, tf2_msgs/TFMessage and std_msgs/String.
/// @param encoding  kCdrEncoding, kRos1Encoding or kJsonEncoding. JSON has the fields of ROS 2.
std::vector<ClientChannel> pose_channels(std::string_view encoding);

/// The messages of a pose, one for each channel, in the order of the channels.
std::vector<std::string> pose_messages(const PublishedPose& pose, std::string_view encoding);

}  // namespace fovea::bridge
