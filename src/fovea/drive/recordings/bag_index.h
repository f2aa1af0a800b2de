// What one pass over recordings finds: everything but the scans and images themselves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fovea/drive/recordings/bag_sink.h"
#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/drive/recordings/transform_tree.h"
#include "fovea/drive/scans/scan_numbers.h"

namespace fovea {

/// Messages that cannot be used.
struct UnusableMessages {
  std::size_t count = 0;
  std::string first_problem, first_remedy;

  void add(const std::string& problem, const std::string& remedy = "") {
    if (count++ == 0) first_problem = problem, first_remedy = remedy;
  }
  /// What to tell of them.
  std::string note(const std::string& topic) const;
};

/// InputError for a message without a stamp.
void check_stamp(const ros::Header& header);
/// InputError also if the message is of another frame than the first one of its topic.
void check_header(const ros::Header& header, const std::string& frame);

/// A topic of scans or images.
struct SensorTopic {
  std::string frame;           ///< of its first message; those of other frames are unusable
  std::vector<TimeNs> stamps;  ///< ascending, each once
  std::vector<ScanNumbers> first_scans;  ///< some of the first, with times if any has times
  std::string unread;  ///< why images like the first are not read; empty if they are
  std::uint32_t width = 0, height = 0;  ///< of the first image; 0 of compressed ones
};

/// By topics' names. In order of stamps, as far as the messages have any.
struct BagIndex {
  std::map<std::string, BagTopic> topics;       ///< all
  std::map<std::string, std::size_t> messages;  ///< their numbers, of all topics
  std::map<std::string, SensorTopic> lidars, images;
  std::map<std::string, ros::CameraInfo> camera_infos;  ///< the first of each that has a K
  std::map<std::string, std::vector<ros::NavSatFix>> fixes;
  std::map<std::string, std::vector<ros::Imu>> imus;
  std::map<std::string, std::vector<ros::Odometry>> odometries;
  TransformTree transforms;
  std::map<std::string, UnusableMessages> unusable;
  std::vector<std::string> losses;  ///< files that could be read in part only
};

/// Reads recordings that belong together. A message that cannot be read or has no stamp, and a scan
/// or image with the stamp of another, is counted as unusable. InputError as read_bag_file.
/// @param files    as bag_files() gives them
/// @param scratch  as for read_bag_file
BagIndex index_bags(const std::vector<std::filesystem::path>& files,
                    const std::filesystem::path& scratch);

}  // namespace fovea
