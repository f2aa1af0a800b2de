#include "fovea/drive/recordings/lidar_topics.h"

#include <fmt/format.h>

#include <set>

#include "fovea/drive/recordings/only_topic.h"
#include "fovea/drive/recordings/place_on_vehicle.h"
#include "fovea/drive/recordings/sensor_name.h"
#include "fovea/drive/recordings/velodyne_scan.h"
#include "fovea/drive/scans/recognized_format.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Recognizes the units of the scans. Times that have no meaning are not used, which a note says.
ScanFormat recognize_scans(const SensorTopic& lidar, const std::string& topic,
                           std::vector<std::string>& notes) {
  const auto recognize = [&](const StatedScanFormat& stated) {
    const RecognizedFormat recognized = recognize_format(lidar.first_scans, stated);
    const ScanFormat& format = recognized.format;
    const bool timed = format.time_unit && format.time_reference != TimeReference::kNone;
    notes.push_back(fmt::format("scans: {} of {}, {}", lidar.stamps.size(), topic,
                                timed ? "points have times" : "points have no times"));
    for (const FormatNote& note : recognized.notes) notes.push_back(note.what);
    return format;
  };
  try {
    return recognize({});
  } catch (const ConfigError& error) {
    if (!error.where().starts_with("lidar.time_")) {
      throw InputError(error.problem(), topic, "record coordinates in m, in the LiDAR's frame");
    }
  }
  StatedScanFormat stated;
  try {
    stated.time_reference = TimeReference::kFirstPoint;
    const ScanFormat format = recognize(stated);
    notes.emplace_back(
        "the points' times are of another clock than the stamps: the stamp of a scan "
        "counts as the time of its first point");
    return format;
  } catch (const ConfigError& error) {
    notes.push_back("the times of points are not used: " + error.problem());
    stated.time_reference = TimeReference::kNone;
    return recognize(stated);
  }
}

/// The topics that may be the LiDAR: packets only if there are no point clouds.
std::map<std::string, SensorTopic> lidar_topics(const BagIndex& index,
                                                const ConvertOptions& options) {
  std::map<std::string, SensorTopic> clouds = index.lidars;
  std::erase_if(clouds, [&](const auto& lidar) {
    return index.topics.at(lidar.first).type == ros::kVelodyneScan;
  });
  return clouds.empty() || !options.lidars.empty() ? index.lidars : clouds;
}

/// "/sensors/left/points" is sensors_left. A number distinguishes LiDARs of one name.
std::string lidar_name(const std::string& topic, std::set<std::string>& names) {
  const std::string name = sensor_name(topic.substr(0, topic.rfind('/')), "lidar");
  std::string unused = name;
  for (int number = 2; !names.insert(unused).second; ++number) {
    unused = fmt::format("{}_{}", name, number);
  }
  return unused;
}

}  // namespace

std::vector<PlannedLidar> plan_lidars(const BagIndex& index, const ConvertOptions& options,
                                      std::vector<std::string>& notes) {
  std::vector<std::string> wanted = options.lidars;
  if (wanted.empty()) wanted.emplace_back();
  if (wanted.size() > kMaxLidars) {
    throw ConfigError(fmt::format("there are {} LiDARs", wanted.size()), "--lidar",
                      fmt::format("name at most {}", kMaxLidars));
  }
  std::vector<PlannedLidar> lidars;
  std::set<std::string> topics, names;
  std::string first_frame;
  for (const std::string& topic : wanted) {
    PlannedLidar& planned = lidars.emplace_back();
    planned.topic = only_topic(lidar_topics(index, options), topic, "scans", "--lidar");
    if (!topics.insert(planned.topic).second) {
      throw ConfigError("the LiDAR is named twice", "--lidar " + topic, "name each one once");
    }
    const SensorTopic& lidar = index.lidars.at(planned.topic);
    planned.lidar.sweep_compensated = options.sweep_compensated;
    planned.format = recognize_scans(lidar, planned.topic, notes);
    if (wanted.size() == 1) continue;
    planned.lidar.name = lidar_name(planned.topic, names);
    if (lidars.size() == 1) {
      first_frame = lidar.frame;
    } else if (lidar.frame != first_frame) {
      planned.lidar.T_lidar_sensor =
          place_on_vehicle(index, first_frame, lidar.frame, planned.topic);
    }
  }
  return lidars;
}

}  // namespace fovea
