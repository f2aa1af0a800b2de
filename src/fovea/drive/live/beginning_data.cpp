#include "fovea/drive/live/beginning_data.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/drive/drive_files.h"
#include "fovea/drive/live/live_sensors.h"

namespace fovea {
namespace {

bool has(const std::vector<int>& numbers, int number) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

/// Whether images of a camera began before the last of the first scans.
bool has_image_of_first_scans(const FrameQueue& queue, std::size_t camera, std::size_t scans) {
  const auto& images = queue.images(camera).items();
  if (images.empty() || queue.scans().empty()) return false;
  const std::size_t last = std::min(scans, queue.scans().size()) - 1;
  return images.front()->stamp <= queue.scans()[last].scan->stamp;
}

void add_missing_images(const FrameQueue& queue, const DriveDescription& description,
                        const LiveOptions& options, std::vector<std::string>& missing) {
  if (!options.drive.use_images || description.cameras.empty()) return;
  const std::vector<int> all = camera_numbers(description);
  const std::vector<int> chosen = choose_cameras(all, options.drive, options.name);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!has(chosen, all[i]) || has_image_of_first_scans(queue, i, options.first_scans)) continue;
    missing.push_back("images of camera " + description.cameras[i].name);
  }
}

}  // namespace

std::vector<std::string> missing_data(const FrameQueue& queue, const LiveMotion& motion,
                                      const DriveDescription& description,
                                      const LiveOptions& options) {
  std::vector<std::string> missing;
  const std::size_t scans = queue.scans().size(), first_scans = options.first_scans;
  if (scans < first_scans) {
    missing.push_back(scans == 0 ? "scans"
                                 : fmt::format("{} of {} scans", first_scans - scans, first_scans));
  }
  for (std::size_t i = 0; i < description.further_lidars.size(); ++i) {
    if (!queue.further_scans(i).items().empty()) continue;
    missing.push_back("scans of LiDAR " + description.further_lidars[i].name);
  }
  add_missing_images(queue, description, options, missing);
  if (options.expects_navigation && options.drive.use_navigation && !motion.has_navigation()) {
    missing.emplace_back("poses or positions");
  }
  if (options.drive.use_imu && description.imu && !motion.has_inertia()) {
    missing.emplace_back("records of the IMU");
  }
  return missing;
}

FirstData first_data(const FrameQueue& queue, const DriveDescription& description,
                     std::size_t scans) {
  FirstData first;
  for (const FrameQueue::PendingScan& pending : queue.scans()) {
    if (first.scans.size() < scans) first.scans.push_back(pending.scan);
  }
  for (std::size_t i = 0; i < description.further_lidars.size(); ++i) {
    const auto& items = queue.further_scans(i).items();
    first.further_scans.emplace_back(items.begin(), items.end());
  }
  for (std::size_t i = 0; i < description.cameras.size(); ++i) {
    const auto& items = queue.images(i).items();
    first.images.emplace_back(items.begin(), items.end());
  }
  return first;
}

SensorUse find_use(const DriveDescription& description, const DriveOptions& options,
                   const LiveBeginning& beginning, bool by_poses) {
  const LiveSensors sensors(description);
  const DriveInfo& info = beginning.info;
  SensorUse use{std::vector<bool>(sensors.size()), std::vector<bool>(sensors.size())};
  auto& [is_used, is_wanted] = use;
  is_used[LiveSensors::kLidar] = true;
  for (std::size_t i = 0; i < description.further_lidars.size(); ++i) {
    is_wanted[sensors.further_lidar(i)] = true;
  }
  for (const std::size_t i : beginning.sensors.further_lidars) {
    is_used[sensors.further_lidar(i)] = true;
  }
  const std::vector<int> numbers = camera_numbers(description);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    is_wanted[sensors.camera(i)] = options.use_images &&
                                   (options.cameras.empty() || has(options.cameras, numbers[i])) &&
                                   !has(info.unused_cameras, numbers[i]);
  }
  for (const std::size_t i : beginning.sensors.cameras) is_used[sensors.camera(i)] = true;
  is_used[sensors.poses()] = info.navigation && by_poses;
  is_used[sensors.positions()] = info.navigation && !by_poses;
  is_used[sensors.imu()] = info.imu.has_value();
  is_used[sensors.wheels()] = info.wheels.has_value();
  is_wanted[sensors.imu()] = options.use_imu && description.imu;
  is_wanted[sensors.wheels()] = options.use_imu;
  return use;
}

}  // namespace fovea
