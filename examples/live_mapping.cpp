// Maps while sensors measure: live_mapping DRIVE MAP.fovea. A drive stands for the robot.
#include <fovea/fovea.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  const fovea::Drive robot(folder);  // yours: the sensors of a robot
  std::ostringstream drive_toml;
  drive_toml << std::ifstream(folder / "drive.toml").rdbuf();

  fovea::LiveMapperOptions options;
  options.expects_navigation = true;
  options.on_pose = [](const fovea::LivePose& pose) {
    std::printf("%d %s\n", pose.index, pose.state.c_str());
  };
  fovea::LiveMapper mapper(drive_toml.str(), arguments[2], options);

  const auto now = std::chrono::steady_clock::now();
  const auto start = now - std::chrono::nanoseconds(robot.load(0).stamp());
  const auto wait_until = [&](fovea::TimeNs stamp) {
    std::this_thread::sleep_until(start + std::chrono::nanoseconds(stamp));
  };
  std::jthread poses([&] {
    for (const fovea::StampedPose& pose : robot.navigation().value().poses()) {
      wait_until(pose.time);
      mapper.add_pose(pose.time, pose.T_local_body * robot.T_body_lidar()->inverse());
    }
  });
  std::jthread frames([&] {
    for (const int index : robot.frames()) {
      const fovea::DriveFrame frame = robot.load(index);
      wait_until(frame.stamp());
      mapper.add_scan(frame.stamp(), frame.scan());
      mapper.add_image("camera_2", frame.stamp(), frame.images().front());
    }
  });
  poses.join();
  frames.join();
  std::printf("%zu points\n", mapper.close().points);
}
