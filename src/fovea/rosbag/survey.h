// What one pass over recordings finds: everything but the scans and images themselves.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fovea/rosbag/bag_sink.h"
#include "fovea/rosbag/ros_messages.h"
#include "fovea/rosbag/transform_tree.h"
#include "fovea/sensor/lidar_scan.h"

namespace fovea {

/// Messages that cannot be used.
struct UnusableMessages {
  std::size_t count = 0;
  std::string first_problem;

  void add(const std::string& problem) {
    if (count++ == 0) first_problem = problem;
  }
};

/// A topic of scans or images.
struct SensorTopic {
  std::string frame;           ///< of its first message
  std::vector<TimeNs> stamps;  ///< ascending, each once
  std::string encoding;        ///< of its first image, if it has plain ones
  ScanFormat scan_format;      ///< of its first scan
};

/// By topics' names. In order of stamps, as far as the messages have any.
struct BagSurvey {
  std::map<std::string, BagTopic> topics;  ///< all
  std::map<std::string, SensorTopic> clouds, images;
  std::map<std::string, ros::CameraInfo> camera_infos;  ///< the first of each
  std::map<std::string, std::vector<ros::NavSatFix>> fixes;
  std::map<std::string, std::vector<ros::Imu>> imus;
  std::map<std::string, std::vector<ros::Odometry>> odometries;
  TransformTree transforms;
  std::map<std::string, UnusableMessages> unusable;
};

/// Reads recordings that belong together. A message that cannot be read, or a scan or image without
/// a stamp or with that of another, is counted as unusable. InputError as read_bag_file.
/// @param files  as bag_files() gives them
BagSurvey survey_bags(const std::vector<std::filesystem::path>& files);

}  // namespace fovea
