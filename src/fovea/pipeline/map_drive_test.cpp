// Runs over whole drives: errors, stages in parallel, memory, live frames.
#include "fovea/pipeline/map_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../tests/raw_drive.h"
#include "fovea/core/parallel.h"
#include "fovea/map/camera_models.h"
#include "fovea/map/drive_fingerprint.h"
#include "fovea/pipeline/map_drive_test_support.h"

namespace fovea::map_drive_test {

TEST_F(MapDrive, CamerasThatSeeNoPointAreAnErrorAndLeaveNoMap) {
  Camera& camera = drive_.editable_info().calibration.cameras.at(0);
  // Upward: z of the camera is z of the LiDAR.
  camera.T_cam_lidar.linear().setIdentity();
  MapJob job = this->job();
  job.checkpoint_frames = 1;
  try {
    map_drive(drive_, job, {});
    ADD_FAILURE() << "mapped";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no camera sees a point of 8 scans"));
  }
  EXPECT_FALSE(std::filesystem::exists(job.output));
}

TEST_F(MapDrive, WhatNeedsACameraIsRefusedWithoutOne) {
  drive_.editable_info().calibration = {};
  MapJob job = this->job();
  job.settings = PaperOptions();
  EXPECT_THROW(map_drive(drive_, job, {}), InputError);
  job.settings = this->job().settings;
  job.calibrate = true;
  EXPECT_THROW(map_drive(drive_, job, {}), InputError);
  job.calibrate = false;
  EXPECT_GT(map_drive(drive_, job, {}).points, 0u);
}

TEST_F(MapDrive, OverlapChangesNothing) {
  std::vector<std::string> digests;
  for (const auto& [threads, overlap] :
       {std::pair(2, false), {1, true}, {2, true}, {4, true}, {4, true}}) {
    const ThreadLimit limit(threads);
    MapJob job = this->job();
    job.overlap = overlap;
    std::vector<int> told;
    map_drive(drive_, job, [&](const RunProgress& progress) {
      told.push_back(progress.latest->index);
      EXPECT_EQ(progress.done, static_cast<int>(told.size()));
    });
    EXPECT_EQ(told, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    digests.push_back(digest());
    EXPECT_EQ(digests.back(), digests.front()) << threads << " threads";
  }
  EXPECT_GT(MapReader(job().output).submaps().size(), 1u);
}

TEST_F(MapDrive, AnErrorEndsTheRunAndLeavesNothing) {
  drive_.error_at = 4;
  for (const bool overlap : {false, true}) {
    MapJob job = this->job();
    job.overlap = overlap;
    int done = 0;
    EXPECT_THROW(map_drive(drive_, job, [&](const RunProgress&) { ++done; }), InputError);
    EXPECT_EQ(done, 4);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
    // One of the last stage, while the others are at work.
    EXPECT_THROW(map_drive(drive_, job, [](const RunProgress&) { throw OutputError("", "", ""); }),
                 OutputError);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  }
}

TEST_F(MapDrive, TheMapStatesItsDriveSensorAndViews) {
  drive_.editable_info().origin = GeodeticPoint{49, 8, 110};
  map_drive(drive_, job(), {});
  const MapReader map(job().output);
  const std::vector<DriveRecord> drives = map.drives();
  ASSERT_EQ(drives.size(), 1u);
  EXPECT_EQ(drives[0].calibration_fingerprint,
            calibration_fingerprint(drive_.info().calibration, {}));
  std::vector<std::optional<TimeNs>> stamps;
  for (int i = 0; i < 8; ++i) stamps.push_back(drive_.stamp(i));
  EXPECT_EQ(drives[0].stamps_fingerprint, stamps_fingerprint(0, stamps));
  EXPECT_EQ(drives[0].end_frame, 8);
  ASSERT_TRUE(drives[0].origin);
  EXPECT_EQ(drives[0].origin->altitude, 110);
  EXPECT_EQ(drives[0].datum, "WGS 84");
  EXPECT_EQ(drives[0].height_type, HeightType::kEllipsoidal);
  ASSERT_EQ(map.sensors().size(), 1u);
  EXPECT_EQ(map.sensors()[0].profile.sweep, drive_.info().sweep);
  for (const FrameRecord& frame : map.frames()) {
    ASSERT_EQ(frame.views.size(), 1u);
    EXPECT_EQ(frame.views[0].camera, drive_.info().calibration.cameras[0].index);
    EXPECT_EQ(frame.views[0].stamp, frame.stamp);
    ASSERT_EQ(frame.views[0].log2_gain.has_value(), frame.status == FrameStatus::kMapped);
    if (frame.views[0].log2_gain) {
      EXPECT_LT(frame.views[0].log2_gain->cwiseAbs().maxCoeff(), 0.02);
    }
  }
}

TEST_F(MapDrive, TheMapStatesItsCameras) {
  map_drive(drive_, job(), {});
  const std::vector<Camera> stated = camera_models(MapReader(job().output).meta(), 0);
  const Camera& expected = drive_.info().calibration.cameras.at(0);
  ASSERT_EQ(stated.size(), 1u);
  EXPECT_EQ(stated[0].index, expected.index);
  EXPECT_EQ(stated[0].fx, expected.fx);
  EXPECT_EQ(stated[0].T_cam_lidar.matrix(), expected.T_cam_lidar.matrix());
}

/// Leaves a place and comes back to it twice; 100 m lie between the two.
class ThereAndBack : public BrokenDrive {
 public:
  ThereAndBack() {
    scene.boxes = {{{-30, -30, -2}, {150, 30, -1.73}}, {{-30, 6, -2}, {150, 8, 4}}};
    std::vector<StampedPose> navigation;
    for (int i = 0; i < 8; ++i) {
      RigidMotion& T = T_local_lidar[std::size_t(i)];
      T = RigidMotion(Eigen::Translation3d((i % 4 < 2 ? 0 : 100) + i, 0, 0));
      navigation.push_back({stamp_of(i), T});
    }
    editable_info().navigation = Trajectory(navigation);
  }
};

TEST_F(MapDrive, WhatIsOutOfReachNeedNotBeInMemory) {
  const ThereAndBack drive;
  MapJob job = this->job();
  job.pose_source = PoseSource::kNavigation;
  job.settings.mapper().fusion.submap_duration = 0.05;
  std::vector<std::string> digests;
  std::vector<std::size_t> points;
  for (const auto& [frames, memory] :
       {std::pair(100, std::size_t{1} << 30), {1, std::size_t{1} << 30}, {2, std::size_t{1}}}) {
    for (const bool overlap : {false, true}) {
      job.overlap = overlap;
      job.checkpoint_frames = std::size_t(frames);
      job.memory = memory;
      const MapSummary summary = map_drive(drive, job, {});
      digests.push_back(digest());
      EXPECT_EQ(digests.back(), digests.front()) << frames;
      EXPECT_EQ(summary.points, MapReader(job.output).size());
    }
  }
  // The same while it is resumed again and again.
  job.checkpoint_frames = 1;
  std::filesystem::remove(job.output);
  for (int end = 1; end <= 8; ++end) {
    std::stop_source stop;
    job.stop = stop.get_token();
    job.resume = end > 1;
    map_drive(drive, job, [&](const RunProgress& progress) {
      if (progress.done >= end) stop.request_stop();
    });
  }
  EXPECT_EQ(digest(), digests.front());
}

TEST_F(MapDrive, TellsWhatMemoryItNeededBeyondTheLimit) {
  drive_.editable_info().end = 2;
  MapJob job = this->job();
  EXPECT_THAT(map_drive(drive_, job, {}).notes,
              testing::Not(testing::Contains(testing::HasSubstr("memory"))));
  job.memory = 1 << 20;
  EXPECT_THAT(map_drive(drive_, job, {}).notes,
              testing::Contains(testing::HasSubstr("more than the 1 MB")));
}

TEST_F(MapDrive, LateFramesAreCountedAndMapped) {
  drive_.editable_info().end = 4;
  EXPECT_EQ(map_drive(drive_, job(), {}).late_frames, 0);
  const std::string unhurried = digest();
  MapJob job = this->job();
  job.rate = 1e6;  // no frame is mapped in a microsecond
  const MapSummary summary = map_drive(drive_, job, {});
  EXPECT_EQ(summary.late_frames, 4);
  EXPECT_EQ(summary.frames_mapped + summary.frames_held_out, 4);
  EXPECT_EQ(digest(), unhurried);
}

// However slow the machine: what takes no longer than its two seconds is in time.
TEST_F(MapDrive, FramesInTimeAreNotLate) {
  drive_.editable_info().end = 2;
  MapJob job = this->job();
  job.rate = 0.5;
  int too_slow = 0;
  const auto start = std::chrono::steady_clock::now();
  const MapSummary summary = map_drive(drive_, job, [&](const RunProgress& progress) {
    too_slow += progress.latest->milliseconds.at("frame") > 2000;
  });
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  EXPECT_EQ(summary.late_frames, too_slow);
  EXPECT_EQ(summary.rate, 0.5);
}

TEST_F(MapDrive, AFrameIsAsLateAsAllThatItWaitedFor) {
  drive_.editable_info().end = 4;
  MapJob job = this->job();
  job.rate = 1e6;
  std::vector<double> latencies, in_turn;
  map_drive(drive_, job, [&](const RunProgress& progress) {
    const auto& ms = progress.latest->milliseconds;
    latencies.push_back(ms.at("frame"));
    // What the scan alone shows is made beside the registration, and a scan becomes a target while
    // the next one waits. These two never overlap.
    in_turn.push_back(ms.at("wait") + (ms.contains("store") ? ms.at("store") : 0));
  });
  for (std::size_t i = 0; i < latencies.size(); ++i) EXPECT_GE(latencies[i], in_turn[i]);
  // All arrive in the first microseconds, and end one after the other.
  EXPECT_THAT(latencies, testing::WhenSorted(testing::ElementsAreArray(latencies)));
}

}  // namespace fovea::map_drive_test
