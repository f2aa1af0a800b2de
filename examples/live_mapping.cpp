// Maps while sensors measure: live_mapping DRIVE MAP.fovea. A drive stands for the robot.
#include <fovea/core/read_file.h>
#include <fovea/pipeline/config.h>
#include <fovea/pipeline/map_live.h>

#include <cstdio>
#include <thread>
int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  const auto robot = fovea::open_drive(folder, {});  // yours: the sensors of a robot
  const fovea::DriveInfo& info = robot->info();
  fovea::LiveOptions options;
  options.expects_navigation = true;
  fovea::LiveSource source(fovea::read_text(folder / "drive.toml"), options);
  const auto start = std::chrono::steady_clock::now() - std::chrono::nanoseconds(*robot->stamp(0));
  const auto wait_until = [&](fovea::TimeNs stamp) {
    std::this_thread::sleep_until(start + std::chrono::nanoseconds(stamp));
  };
  std::jthread poses([&] {
    for (const fovea::StampedPose& pose : info.navigation.value().poses()) {
      wait_until(pose.time);
      source.add_pose({pose.time, pose.T_local_body * info.calibration.T_imu_lidar->inverse()});
    }
  });
  std::jthread frames([&] {
    for (const int index : info.frame_indices()) {
      const fovea::Frame frame = std::get<fovea::Frame>(robot->load(index));
      wait_until(frame.stamp);
      source.add_scan({"", frame.stamp, frame.scan});
      source.add_image({"camera_2", frame.stamp, frame.images.front()});
    }
    poses.join();
    source.close();
  });
  fovea::MapJob job;
  job.output = arguments[2];
  job.settings = fovea::load_preset("default");
  job.on_tracked = [](const auto& frame) { std::printf("%d\n", frame.index); };
  std::printf("%zu points\n", fovea::map_live(source, job, {}).points);
}
