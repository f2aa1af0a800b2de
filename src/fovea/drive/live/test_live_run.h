// For tests: all that a live source gives, and whether it equals a drive in a folder.
#pragma once

#include <gtest/gtest.h>

#include <thread>

#include "fovea/drive/live/test_live_drive.h"

namespace fovea::test {

/// All that a source gives.
struct PlayedDrive {
  DriveInfo info;
  std::vector<LoadedFrame> first;  ///< of begin()
  std::vector<LoadedFrame> frames;
  LiveFigures figures;
};

inline LiveOptions all_data() {
  LiveOptions options;
  options.drive.cameras = {3, 0};
  options.waits = true;
  // Nothing may wait that long.
  options.max_wait = 20;
  options.longest_beginning = 60;
  return options;
}

/// Reads a source to its end.
inline PlayedDrive read_all(LiveSource& source) {
  PlayedDrive run;
  const std::unique_ptr<FrameSource> first = source.begin({});
  if (!first) {
    ADD_FAILURE() << "no beginning";
    return run;
  }
  run.info = first->info();
  for (const int index : run.info.frames) run.first.push_back(first->load(index));
  while (std::optional<LiveFrame> frame = source.next({})) {
    run.frames.push_back(std::move(frame->frame));
  }
  run.figures = source.figures();
  return run;
}

/// Sends the data from one thread, in the order of the stamps.
inline PlayedDrive play(const LiveData& data, const std::string& toml, const LiveOptions& options) {
  LiveSource source(toml, options);
  const std::jthread sensors([&] {
    for (const auto& [time, call] : data.calls()) call(source);
    source.close();
  });
  return read_all(source);
}

inline void expect_equal(const RigidMotion& a, const RigidMotion& b) {
  EXPECT_EQ(a.matrix(), b.matrix());
}

inline void expect_equal(const StampedPose& a, const StampedPose& b) {
  EXPECT_EQ(a.time, b.time);
  expect_equal(a.T_local_body, b.T_local_body);
  EXPECT_EQ(a.velocity, b.velocity);
}

inline void expect_equal(const ImuSample& a, const ImuSample& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.rate, b.rate);
  EXPECT_EQ(a.force, b.force);
}

inline void expect_equal(const WheelSpeed& a, const WheelSpeed& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.speed, b.speed);
}

inline void expect_equal(double a, double b) { EXPECT_EQ(a, b); }

/// The results of a beginning and of the frames are a beginning of the file's.
/// @param most  that may be missing at the end, after the last sweep
template <class Result>
inline void expect_beginning(const std::vector<Result>& live, const std::vector<Result>& file,
                             std::size_t most) {
  ASSERT_LE(live.size(), file.size());
  EXPECT_GE(live.size() + most, file.size());
  for (std::size_t i = 0; i < live.size(); ++i) expect_equal(live[i], file[i]);
}

/// Differences of times round otherwise where a compiler fuses them with a product.
inline void expect_same_offset(double a, double b) { EXPECT_NEAR(a, b, 1e-15); }

inline void expect_equal(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.scan.position, b.scan.position);
  EXPECT_EQ(a.scan.intensity, b.scan.intensity);
  EXPECT_EQ(a.scan.time, b.scan.time);
  EXPECT_EQ(a.scan.ring, b.scan.ring);
  EXPECT_EQ(a.scan.sensor, b.scan.sensor);
  EXPECT_EQ(a.dropped_points, b.dropped_points);
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) EXPECT_EQ(a.images[i].data, b.images[i].data);
  ASSERT_EQ(a.image_offsets.size(), b.image_offsets.size());
  for (std::size_t i = 0; i < a.image_offsets.size(); ++i) {
    expect_same_offset(a.image_offsets[i], b.image_offsets[i]);
  }
  EXPECT_EQ(a.image_exposures, b.image_exposures);
  EXPECT_EQ(a.missing_images.size(), b.missing_images.size());
  EXPECT_EQ(a.missing_scans.size(), b.missing_scans.size());
}

inline void expect_equal(const LoadedFrame& a, const LoadedFrame& b) {
  ASSERT_EQ(a.index(), b.index());
  if (const auto* frame = std::get_if<Frame>(&a)) return expect_equal(*frame, std::get<Frame>(b));
  EXPECT_EQ(std::get<SkippedFrame>(a).index, std::get<SkippedFrame>(b).index);
  EXPECT_EQ(std::get<SkippedFrame>(a).reason, std::get<SkippedFrame>(b).reason);
}

inline void expect_same_sensors(const DriveInfo& live, const DriveInfo& file) {
  EXPECT_EQ(live.sweep, file.sweep);
  EXPECT_EQ(live.sweep_compensated, file.sweep_compensated);
  EXPECT_EQ(live.times_by_azimuth, file.times_by_azimuth);
  EXPECT_EQ(live.has_time_stamps, file.has_time_stamps);
  EXPECT_EQ(live.image_stamps_are_capture_times, file.image_stamps_are_capture_times);
  EXPECT_EQ(live.unused_cameras, file.unused_cameras);
  ASSERT_EQ(live.lidars.size(), file.lidars.size());
  for (std::size_t i = 0; i < live.lidars.size(); ++i) {
    EXPECT_EQ(live.lidars[i].profile, file.lidars[i].profile);
    expect_equal(live.lidars[i].T_lidar_sensor, file.lidars[i].T_lidar_sensor);
  }
  ASSERT_EQ(live.calibration.cameras.size(), file.calibration.cameras.size());
  for (std::size_t i = 0; i < live.calibration.cameras.size(); ++i) {
    const Camera &a = live.calibration.cameras[i], &b = file.calibration.cameras[i];
    EXPECT_EQ(a.index, b.index);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.fx, b.fx);
    EXPECT_EQ(a.cx, b.cx);
    EXPECT_EQ(a.image_delay, b.image_delay);
    expect_equal(a.T_cam_lidar, b.T_cam_lidar);
  }
  ASSERT_EQ(live.calibration.T_imu_lidar.has_value(), file.calibration.T_imu_lidar.has_value());
  if (live.calibration.T_imu_lidar) {
    expect_equal(*live.calibration.T_imu_lidar, *file.calibration.T_imu_lidar);
  }
  ASSERT_EQ(live.origin.has_value(), file.origin.has_value());
  if (live.origin) {
    EXPECT_EQ(live.origin->latitude, file.origin->latitude);
    EXPECT_EQ(live.origin->longitude, file.origin->longitude);
    EXPECT_EQ(live.origin->altitude, file.origin->altitude);
  }
}

/// Poses, accelerations and speeds of a run, from its beginning and its frames.
inline void expect_same_motion(const PlayedDrive& live, const DriveInfo& file) {
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  MotionData all;
  ASSERT_EQ(live.info.navigation.has_value(), file.navigation.has_value());
  ASSERT_EQ(live.info.imu.has_value(), file.imu.has_value());
  ASSERT_EQ(live.info.wheels.has_value(), file.wheels.has_value());
  if (file.navigation) all.poses = live.info.navigation->poses();
  all.accuracy = live.info.navigation_accuracy;
  if (file.imu) all.imu = live.info.imu->samples;
  if (file.wheels) all.wheels = live.info.wheels->samples;
  for (const LoadedFrame& loaded : live.frames) {
    const auto* frame = std::get_if<Frame>(&loaded);
    if (frame == nullptr) continue;
    append(all.poses, frame->motion.poses);
    append(all.accuracy, frame->motion.accuracy);
    append(all.imu, frame->motion.imu);
    append(all.wheels, frame->motion.wheels);
  }
  if (file.navigation) expect_beginning(all.poses, file.navigation->poses(), 3);
  expect_beginning(all.accuracy, file.navigation_accuracy, 3);
  if (file.imu) {
    expect_equal(live.info.imu->T_lidar_imu, file.imu->T_lidar_imu);
    expect_beginning(all.imu, file.imu->samples, 6);
  }
  if (file.wheels) expect_beginning(all.wheels, file.wheels->samples, 2);
}

inline void expect_same(const PlayedDrive& live, const FrameSource& file) {
  expect_same_sensors(live.info, file.info());
  expect_same_motion(live, file.info());
  const std::vector<int> indices = file.info().frame_indices();
  ASSERT_EQ(live.frames.size(), indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    expect_equal(live.frames[i], file.load(indices[i]));
  }
  ASSERT_EQ(live.info.frames.size(), live.first.size());
  for (std::size_t i = 0; i < live.first.size(); ++i) {
    expect_equal(live.first[i], live.frames[i]);
    for (std::size_t slot = 0; slot < live.info.calibration.cameras.size(); ++slot) {
      expect_same_offset(live.info.image_offset(slot, indices[i]),
                         file.info().image_offset(slot, indices[i]));
    }
  }
}

}  // namespace fovea::test
