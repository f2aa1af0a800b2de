// For tests: a small drive in memory, and the same in a folder.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "../../../../tests/kitti_test_drive.h"
#include "fovea/drive/live/live_source.h"
#include "fovea/drive/writers/png_encode.h"

namespace fovea::test {

/// Of a source whose senders wait, and for which nothing is late.
inline LiveOptions patient_options() {
  LiveOptions options;
  options.waits = true;
  options.max_wait = options.longest_beginning = 60;
  return options;
}

inline constexpr TimeNs kLiveStart = 1'700'000'000'000'000'000, kLiveStep = kNsPerSecond / 10;
inline constexpr int kLiveWidth = 64, kLiveHeight = 40;

/// What the sensors of a vehicle send.
struct LiveData {
  RecordedDrive drive;  ///< the sensors, without data
  std::vector<LiveScan> scans;
  std::vector<LiveImage> images;
  std::vector<RecordedPose> poses;
  std::vector<RecordedPosition> positions;
  std::vector<RecordedInertia> inertia;
  std::vector<WheelSpeed> wheels;

  /// Writes it as a drive, and returns its drive.toml.
  std::string write(const std::filesystem::path& root) const {
    GenericDriveWriter writer(root, /*force=*/true);
    std::map<std::string, int> numbers;
    for (const LiveScan& scan : scans) {
      writer.write_scan(numbers["scans of " + scan.lidar]++, scan.stamp, scan.points,
                        ScanFile::kPcd, scan.lidar);
    }
    for (const LiveImage& image : images) {
      const int number = numbers["images of " + image.camera]++;
      writer.write_encoded_image(image.camera, number, image.stamp,
                                 std::get<std::string>(image.content), ".png");
      if (image.exposure) writer.set_exposure(image.camera, number, *image.exposure);
    }
    RecordedDrive all = drive;
    all.poses = poses;
    all.positions = positions;
    all.inertia = inertia;
    all.wheels = wheels;
    writer.finish(all);
    return read_text(root / "drive.toml");
  }

  /// Calls of a source, in the order of the stamps.
  std::vector<std::pair<TimeNs, std::function<void(LiveSource&)>>> calls() const {
    std::vector<std::pair<TimeNs, std::function<void(LiveSource&)>>> calls;
    calls.reserve(scans.size() + images.size());
    for (const LiveScan& scan : scans) {
      calls.emplace_back(scan.stamp, [scan](LiveSource& s) { s.add_scan(scan); });
    }
    for (const LiveImage& image : images) {
      calls.emplace_back(image.stamp, [image](LiveSource& s) { s.add_image(image); });
    }
    for (const RecordedPose& pose : poses) {
      calls.emplace_back(pose.time, [pose](LiveSource& s) { s.add_pose(pose); });
    }
    for (const RecordedPosition& position : positions) {
      calls.emplace_back(position.time, [position](LiveSource& s) { s.add_position(position); });
    }
    for (const RecordedInertia& inertial : inertia) {
      calls.emplace_back(inertial.time, [inertial](LiveSource& s) { s.add_inertia(inertial); });
    }
    for (const WheelSpeed& wheel : wheels) {
      calls.emplace_back(wheel.time, [wheel](LiveSource& s) { s.add_wheel_speed(wheel); });
    }
    std::stable_sort(calls.begin(), calls.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    return calls;
  }
};

inline std::string live_png(int number, int width = kLiveWidth, int height = kLiveHeight) {
  Image image = pattern(width, height, 3);
  for (std::uint8_t& sample : image.data) sample = std::uint8_t(sample + 3 * number);
  const std::vector<std::uint8_t> bytes = encode_png(image);
  return {bytes.begin(), bytes.end()};
}

/// @param has_times  of the points
inline LiveScan live_scan(int number, bool has_times = true, const std::string& lidar = "") {
  LiveScan scan;
  scan.lidar = lidar;
  scan.stamp = kLiveStart + number * kLiveStep;
  for (int i = 0; i < 90; ++i) {
    const float azimuth = float(M_PI) - 0.0698f * float(i);
    scan.points.position.emplace_back((8 + 0.1f * float(number)) * std::cos(azimuth),
                                      9 * std::sin(azimuth), 0.1f * float(i % 7));
    scan.points.intensity.push_back(0.01f * float(i));
    scan.points.ring.push_back(std::uint16_t(i % 7));
    if (has_times) scan.points.time.push_back(-0.05f + 0.1f * float(i) / 90);
  }
  return scan;
}

inline RecordedCamera live_camera(const std::string& name, int index, LensModel lens) {
  RecordedCamera camera;
  camera.name = name;
  camera.index = index;
  camera.optics = {kLiveWidth, kLiveHeight, 40, 41, 31.2, 19.7, Lens(lens, {-0.1, 0.01})};
  camera.T_lidar_cam.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  camera.T_lidar_cam.translation = {0.3, 0.01 * index, -0.1};
  return camera;
}

/// Images of a camera at each scan.
/// @param delay  from the stamps of the scans
inline void add_live_images(LiveData& data, const std::string& camera, int scans, TimeNs delay) {
  for (int i = 0; i < scans; ++i) {
    data.images.push_back(
        {camera, kLiveStart + i * kLiveStep + delay, live_png(i), 0.01 + 0.001 * i});
  }
}

/// A car with two cameras, poses at 50 Hz, an IMU at 100 Hz and wheels at 20 Hz.
inline LiveData live_car(int scans) {
  LiveData data;
  data.drive.cameras = {live_camera("front", 0, LensModel::kPlumbBob),
                        live_camera("side", 3, LensModel::kNone)};
  data.drive.T_body_lidar.translation = {0.8, -0.3, 0.9};
  data.drive.T_lidar_imu = QuaternionMotion({0.1, 0.2, 0.3}, {0, 0, 0, 1});
  for (int i = 0; i < scans; ++i) data.scans.push_back(live_scan(i));
  add_live_images(data, "front", scans, kNsPerSecond / 50);
  add_live_images(data, "side", scans, -kNsPerSecond / 100);
  const TimeNs end = kLiveStart + scans * kLiveStep;
  for (TimeNs time = kLiveStart - 3 * kLiveStep; time < end; time += kNsPerSecond / 50) {
    const double t = seconds(time - kLiveStart);
    data.poses.push_back(
        {time,
         {{100 + 8 * t, 0.3 * t * t, 0.01 * t},
          Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * t, Eigen::Vector3d::UnitZ()))}});
  }
  for (TimeNs time = kLiveStart - 3 * kLiveStep; time < end; time += kNsPerSecond / 100) {
    const double t = seconds(time - kLiveStart);
    data.inertia.push_back({time, std::nullopt, {0.01 * t, 0.02, 0.1}, {0.3, 0.01 * t, 9.8}});
  }
  for (TimeNs time = kLiveStart - 3 * kLiveStep; time < end; time += kNsPerSecond / 20) {
    data.wheels.push_back({time, 8 + 0.1 * seconds(time - kLiveStart)});
  }
  return data;
}

/// Positions in place of poses.
/// @param has_attitudes  or orientations of the IMU in place of them
inline LiveData live_car_by_positions(int scans, bool has_attitudes) {
  LiveData data = live_car(scans);
  data.drive.antenna_body = {-0.3, 0, 1.1};
  for (const RecordedPose& pose : data.poses) {
    const double t = seconds(pose.time - kLiveStart);
    RecordedPosition& position = data.positions.emplace_back();
    position.time = pose.time;
    position.antenna = {49 + 1e-4 * t, 8.4 + 1e-5 * t, 110 + 0.1 * t};
    position.accuracy = 0.02 + 0.001 * t;
    if (has_attitudes) position.roll_pitch_yaw = Eigen::Vector3d(0.01, 0.02 * t, 1.5 + 0.01 * t);
    position.velocity = (Twist() << 0, 0, 0.1, 11, 0.1 * t, 0).finished();
  }
  data.poses.clear();
  if (has_attitudes) return data;
  for (RecordedInertia& inertia : data.inertia) {
    const double t = seconds(inertia.time - kLiveStart);
    inertia.R_enu_imu = Eigen::AngleAxisd(1.5 + 0.1 * t, Eigen::Vector3d::UnitZ());
  }
  return data;
}

}  // namespace fovea::test
