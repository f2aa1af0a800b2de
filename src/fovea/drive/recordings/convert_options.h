// What a user may say about a recording.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace fovea {

/// Where poses come from.
enum class NavigationSource {
  kAuto,      ///< the first of the following that the recording has
  kGnss,      ///< NavSatFix and Imu
  kOdometry,  ///< nav_msgs/Odometry
  kTf,        ///< a frame that moves in the tree of tf
  kNone
};

/// Names that are empty are found out.
struct ConvertOptions {
  struct CameraTopic {
    std::string name, topic;
  };

  std::vector<std::string> lidars;   ///< topics of scans, the LiDAR of the drive's frame first
  std::vector<CameraTopic> cameras;  ///< topics of images; empty: all that have a CameraInfo
  NavigationSource poses = NavigationSource::kAuto;
  std::string fix, imu, odometry;  ///< topics
  std::string body, world;         ///< frames of tf
  /// s, the part of the recording from its first scan on.
  double start = 0, duration = std::numeric_limits<double>::infinity();
  bool allow_dropped = false;      ///< however many points are left out
  bool sweep_compensated = false;  ///< something has undone the sweep's motion already
};

}  // namespace fovea
