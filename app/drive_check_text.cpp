#include "app/drive_check_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/sensor_text.h"

namespace fovea::app {
namespace {

std::string frames_text(const DriveCheck& check) {
  std::string text = fmt::format("frames       {}", check.frames);
  if (check.duration) {
    text += fmt::format(", {:.1f} s, {:.2f} Hz, {} pause{}", *check.duration, 1 / *check.period,
                        check.gaps.size(), check.gaps.size() == 1 ? "" : "s");
  }
  return text;
}

std::string scans_text(const DriveCheck& check) {
  return fmt::format(
      "scans        {:.0f} points (median), 90 % of them {:.1f} to {:.1f} m away, {} times, {} "
      "intensity",
      check.points_per_scan, check.near_range, check.far_range,
      check.has_point_times ? "with" : "without", check.has_intensity ? "with" : "without");
}

std::string camera_text(const DriveCheck::CameraFigures& camera, const DriveCheck& check) {
  return fmt::format(
      "camera {}     {} x {} pixels, focal length {:.0f}, images {:+.1f} ms from the scans, {} of "
      "{} missing{}{}",
      camera.number, camera.width, camera.height, camera.focal_px, 1000 * camera.delay,
      camera.missing, check.sampled, camera.has_exposures ? ", exposures stated" : "",
      camera.has_mask ? ", with a mask" : "");
}

std::string navigation_text(const DriveCheck& check) {
  if (check.navigation_poses == 0) return "navigation   none";
  std::string text = fmt::format("navigation   {} poses", check.navigation_poses);
  if (check.navigation_accuracy)
    text += fmt::format(", accuracy {:.2f} m (median)", *check.navigation_accuracy);
  return text;
}

std::string imu_text(const ImuData& imu) {
  const std::vector<ImuSample>& samples = imu.samples;
  const double duration = seconds(samples.back().time - samples.front().time);
  const Eigen::Vector3d place = imu.T_lidar_imu.translation();
  return fmt::format("IMU          {} records at {:.0f} Hz, at {:.2f} {:.2f} {:.2f} m on the LiDAR",
                     samples.size(), double(samples.size() - 1) / duration, place.x(), place.y(),
                     place.z());
}

}  // namespace

std::vector<std::string> lines_of(const DriveCheck& check, const DriveInfo& drive, bool messages) {
  std::vector<std::string> lines = {fmt::format("{} ({})", drive.path.string(), drive.kind),
                                    frames_text(check)};
  for (const MountedLidar& lidar : check.lidars) {
    const std::string name = check.lidars.size() > 1 ? lidar.profile.name + ": " : "";
    const double distance = lidar.T_lidar_sensor.translation().norm();
    const std::string place =
        distance > 0 ? fmt::format(", {:.2f} m from the first one", distance) : "";
    lines.push_back("LiDAR        " + name + to_text(lidar.profile) + place);
  }
  lines.push_back(scans_text(check));
  lines.push_back("dropped      " +
                  (check.dropped.total() == 0 ? "no points" : reasons_of(check.dropped)) +
                  fmt::format(" of {} frames read", check.sampled));
  for (const DriveCheck::CameraFigures& camera : check.cameras)
    lines.push_back(camera_text(camera, check));
  if (check.cameras.empty()) lines.emplace_back("cameras      none");
  lines.push_back(navigation_text(check));
  if (drive.imu) lines.push_back(imu_text(*drive.imu));
  if (drive.wheels) {
    lines.push_back(fmt::format("wheels       {} speeds", drive.wheels->samples.size()));
  }
  lines.emplace_back("`fovea map` would do this:");
  const auto list = [&](const std::vector<std::string>& items) {
    for (const std::string& item : items) lines.push_back("  - " + item);
  };
  const auto is_warning = [&](const std::string& note) {
    return std::find(drive.warnings.begin(), drive.warnings.end(), note) != drive.warnings.end();
  };
  list(check.plan);
  std::vector<std::string> notes = drive.notes, odd = check.oddities;
  std::erase_if(notes, is_warning);
  if (messages) {
    list(notes);
    odd.insert(odd.end(), drive.warnings.begin(), drive.warnings.end());
  }
  if (!odd.empty()) lines.emplace_back("Look at this first:");
  list(odd);
  return lines;
}

}  // namespace fovea::app
