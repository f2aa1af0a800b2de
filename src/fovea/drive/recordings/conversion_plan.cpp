#include "fovea/drive/recordings/conversion_plan.h"

#include <fmt/format.h>

#include "fovea/drive/recordings/scan_message.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

[[noreturn]] void throw_no_scans(const BagIndex& index) {
  for (const auto& [name, unusable] : index.unusable) {
    const auto topic = index.topics.find(name);
    if (topic == index.topics.end() || !is_scan_type(topic->second.type)) continue;
    throw InputError(fmt::format("no scan can be used ({})", unusable.first_problem), name,
                     unusable.first_remedy.empty()
                         ? "restore it from a copy, or see docs/drives.md for what is read"
                         : unusable.first_remedy);
  }
  for (const auto& [name, topic] : index.topics) {
    const std::string_view driver = driver_of_packets(topic.type);
    if (driver.empty()) continue;
    throw InputError(fmt::format("packets of type {} are not read", topic.type), name,
                     fmt::format("run the driver {}, and record its PointCloud2", driver));
  }
  for (const auto& [name, topic] : index.topics) {
    if (topic.is_readable()) continue;
    throw InputError(fmt::format("messages are of encoding '{:.40}'", topic.encoding), name,
                     "give a recording of ROS 2 or ROS 1 (encoding 'cdr' or 'ros1')");
  }
  if (!index.losses.empty()) {
    throw InputError(fmt::format("there are no scans ({})", index.losses.front()),
                     std::string(ros::kPointCloud), "give a whole copy of the recording");
  }
  throw InputError("the recording has no point clouds", std::string(ros::kPointCloud),
                   "record the PointCloud2 of the LiDAR's driver");
}

/// InputError if the two have no time in common: they were stamped by different clocks.
void check_clocks(const std::string& lidar, const std::vector<TimeNs>& scans,
                  const std::string& other, TimeNs first, TimeNs last) {
  if (first <= scans.back() + kNsPerSecond && last >= scans.front() - kNsPerSecond) return;
  throw InputError(fmt::format("stamps have no time in common with those of {}", lidar), other,
                   "have all sensors use one clock");
}

/// InputError if there are more than a drive's files have numbers.
void check_count(const SensorTopic& sensor, const std::string& topic) {
  constexpr std::size_t kMostFiles = 1'000'000;  // of six digits
  if (sensor.stamps.size() <= kMostFiles) return;
  throw InputError(fmt::format("there are {} messages", sensor.stamps.size()), topic,
                   "split the recording: a drive has a million at most");
}

void check_sensors(const BagIndex& index, const ConversionPlan& plan) {
  const std::string& first_lidar = plan.lidars.front().topic;
  const std::vector<TimeNs>& scans = index.lidars.at(first_lidar).stamps;
  const auto check = [&](const std::string& other, TimeNs first, TimeNs last) {
    check_clocks(first_lidar, scans, other, first, last);
  };
  for (const PlannedLidar& planned : plan.lidars) {
    const SensorTopic& lidar = index.lidars.at(planned.topic);
    check(planned.topic, lidar.stamps.front(), lidar.stamps.back());
    check_count(lidar, planned.topic);
  }
  for (const PlannedCamera& camera : plan.cameras) {
    const std::vector<TimeNs>& stamps = index.images.at(camera.topic).stamps;
    check(camera.topic, stamps.front(), stamps.back());
    check_count(index.images.at(camera.topic), camera.topic);
  }
  const RecordedDrive& drive = plan.drive;
  if (!drive.poses.empty()) check("the poses", drive.poses.front().time, drive.poses.back().time);
  if (!drive.positions.empty()) {
    check("the positions", drive.positions.front().time, drive.positions.back().time);
  }
}

}  // namespace

ConversionPlan plan_conversion(const BagIndex& index, const ConvertOptions& options) {
  ConversionPlan plan;
  if (index.lidars.empty()) throw_no_scans(index);
  plan.lidars = plan_lidars(index, options, plan.notes);
  plan.drive.lidar = plan.lidars.front().lidar;
  for (std::size_t k = 1; k < plan.lidars.size(); ++k) {
    plan.drive.further_lidars.push_back(plan.lidars[k].lidar);
  }
  const SensorTopic& lidar = index.lidars.at(plan.lidars.front().topic);
  plan.cameras = plan_cameras(index, options, lidar.frame, plan.notes);
  for (const PlannedCamera& planned : plan.cameras) {
    plan.notes.push_back(fmt::format("camera {}: '{}', {} images of {}", planned.camera.index,
                                     planned.camera.name,
                                     index.images.at(planned.topic).stamps.size(), planned.topic));
    plan.drive.cameras.push_back(planned.camera);
  }
  plan.navigation = plan_navigation(index, options, lidar.frame, plan.drive, plan.notes);
  check_sensors(index, plan);
  return plan;
}

}  // namespace fovea
