// Runs that continue an earlier one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../tests/raw_drive.h"
#include "fovea/core/parallel.h"
#include "fovea/map/drive_fingerprint.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/pipeline/map_drive_test_support.h"

namespace fovea::map_drive_resume_test {

using MapDriveResume = MapDrive;

TEST_F(MapDriveResume, AnInterruptedRunGoesOnToTheSameMap) {
  const ThreadLimit limit(2);
  map_drive(drive_, job(), {});
  const std::string whole = digest();

  std::stop_source stop;
  MapJob job = this->job();
  job.stop = stop.get_token();
  const MapSummary cut = map_drive(drive_, job, [&](const RunProgress& progress) {
    if (progress.done == 3) stop.request_stop();
  });
  ASSERT_TRUE(cut.interrupted);
  // One may have been tracked, and another one may just be.
  EXPECT_LE(cut.frames_mapped + cut.frames_held_out, 3 + 2);
  job.stop = {};
  job.resume = true;
  EXPECT_FALSE(map_drive(drive_, job, {}).interrupted);
  EXPECT_EQ(digest(), whole);
}

// The fingerprints of the drive compare the cameras; maps of older versions do not state them.
TEST_F(MapDriveResume, TheStatedCamerasAreNotCompared) {
  std::stop_source stop;
  MapJob job = this->job();
  job.stop = stop.get_token();
  map_drive(drive_, job, [&](const RunProgress& progress) {
    if (progress.done == 3) stop.request_stop();
  });
  const auto writer = MapWriter::open(job.output);
  const std::string key = "camera_model.0.2";
  ASSERT_TRUE(MapReader(job.output).meta().contains(key));
  writer->put_meta(key, "");
  writer->finish();
  job.stop = {};
  job.resume = true;
  EXPECT_FALSE(map_drive(drive_, job, {}).interrupted);
  EXPECT_NE(MapReader(job.output).meta().at(key), "");
}

// Without navigation too, and with a vehicle that is under way.
TEST_F(MapDriveResume, WithoutCamerasTheMapIsTheSameAtAnyThreadsAndWhenResumed) {
  drive_.editable_info().calibration = {};
  MapJob job = this->job();
  job.checkpoint_frames = 1;
  std::vector<std::string> digests;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    map_drive(drive_, job, {});
    digests.push_back(digest());
  }
  std::stop_source stop;
  MapJob part = job;
  part.overlap = false;
  part.stop = stop.get_token();
  map_drive(drive_, part, [&](const RunProgress& progress) {
    if (progress.done == 3) stop.request_stop();
  });
  part.stop = {};
  part.resume = true;
  map_drive(drive_, part, {});
  digests.push_back(digest());
  EXPECT_THAT(digests, testing::Each(digests.front()));
}

TEST_F(MapDriveResume, ADriveThatBeginsAtSpeedIsMappedAndResumed) {
  const Twist velocity = (Twist() << 0, 0, 0.1, 28, 0, 0).finished();
  for (const bool compensated : {false, true}) {
    RawDrive drive(5, velocity);
    drive.editable_info().sweep_compensated = compensated;
    MapJob job = this->job();
    job.checkpoint_frames = 1;
    map_drive(drive, job, {});
    const std::string whole = digest();
    for (const FrameRecord& record : MapReader(job.output).frames()) {
      const RigidMotion error =
          drive.T_local_lidar[std::size_t(record.index)].inverse() * record.T_local_lidar;
      EXPECT_LT(error.translation().norm(), 0.03) << record.index;
      EXPECT_EQ(record.motion.has_value(), !compensated);
      if (record.motion) {
        EXPECT_LT((record.motion->velocity - velocity).norm(), 0.3) << record.index;
      }
    }
    for (int frames = 1; frames <= 2; ++frames) {
      std::stop_source stop;
      MapJob part = job;
      part.overlap = false;
      part.stop = stop.get_token();
      map_drive(drive, part, [&](const RunProgress& progress) {
        if (progress.done == frames) stop.request_stop();
      });
      part.stop = {};
      part.resume = true;
      map_drive(drive, part, {});
      EXPECT_EQ(digest(), whole) << frames;
    }
  }
}

// A run that ends by an error or a crash has what was committed before, and goes on from there.
TEST_F(MapDriveResume, AnErrorAfterACommitLeavesAMapToGoOnWith) {
  for (const bool overlap : {false, true}) {
    MapJob job = this->job();
    job.overlap = overlap;
    map_drive(drive_, job, {});
    const std::string whole = digest();
    job.checkpoint_frames = 2;
    for (const int error_at : {3, 5, 7}) {
      job.force = true;
      job.resume = false;
      drive_.error_at = error_at;
      EXPECT_THROW(map_drive(drive_, job, {}), InputError);
      drive_.error_at = -1;
      const std::size_t committed = MapReader(job.output).frames().size();
      EXPECT_GE(committed, 2u);
      EXPECT_LE(committed, std::size_t(error_at));
      EXPECT_EQ(MapReader(job.output).meta().at("complete"), "0");
      job.force = false;
      job.resume = true;
      const MapSummary rest = map_drive(drive_, job, {});
      EXPECT_EQ(rest.frames_new, 8 - committed);
      EXPECT_EQ(rest.frames_mapped + rest.frames_held_out, 8);
      EXPECT_EQ(digest(), whole) << error_at;
    }
  }
}

TEST_F(MapDriveResume, ADriveOfAnotherCalibrationOrOtherStampsDoesNotResume) {
  std::stop_source stop;
  MapJob job = this->job();
  job.stop = stop.get_token();
  map_drive(drive_, job, [&](const RunProgress&) { stop.request_stop(); });
  job.stop = {};
  job.resume = true;
  const auto refusal = [&](const FrameSource& drive) -> std::string {
    try {
      map_drive(drive, job, {});
    } catch (const InputError& error) {
      return error.problem();
    }
    return "resumed";
  };
  BrokenDrive recalibrated;
  recalibrated.editable_info().calibration.cameras[0].T_cam_lidar.translation().x() += 0.001;
  EXPECT_EQ(refusal(recalibrated),
            "the map was made of a drive with another calibration (camera 2)");
  BrokenDrive remounted;
  remounted.editable_info().calibration.T_imu_lidar = RigidMotion::Identity();
  EXPECT_EQ(refusal(remounted),
            "the map was made of a drive with another calibration (the place of the IMU)");
  BrokenDrive later;
  later.shift = kNsPerSecond;
  EXPECT_EQ(refusal(later), "the map was made of a drive with other stamps");
  for (const int beams : {47, 24}) {  // with the same stamps, as all simulated drives have
    BrokenDrive elsewhere;
    elsewhere.beams = beams;
    EXPECT_THAT(refusal(elsewhere),
                testing::HasSubstr("made of a drive with other scans: its scan "));
  }
  EXPECT_EQ(refusal(drive_), "resumed");
}

// The name of a drive is no part of its identity, and a note may contain it.
TEST_F(MapDriveResume, ARenamedDriveResumesToTheSameMap) {
  map_drive(drive_, job(), {});
  const std::string whole = digest();
  std::stop_source stop;
  MapJob job = this->job();
  job.stop = stop.get_token();
  map_drive(drive_, job, [&](const RunProgress&) { stop.request_stop(); });
  job.stop = {};
  job.resume = true;
  BrokenDrive renamed;
  renamed.editable_info().path = "elsewhere/renamed";
  renamed.editable_info().notes = {"elsewhere/renamed/stamps.csv has 1 bad line"};
  EXPECT_FALSE(map_drive(renamed, job, {}).interrupted);
  EXPECT_EQ(digest(), whole);
}

TEST_F(MapDriveResume, ACompleteMapIsNotWrittenAgainByResume) {
  const MapSummary made = map_drive(drive_, job(), {});
  const auto written = std::filesystem::last_write_time(job().output);
  MapJob job = this->job();
  job.resume = true;
  const MapSummary resumed = map_drive(drive_, job, {});
  EXPECT_EQ(resumed.notes.back(), "the map is complete: there is nothing to resume");
  EXPECT_FALSE(resumed.interrupted);
  EXPECT_EQ(resumed.points, made.points);
  EXPECT_EQ(resumed.frames_mapped, made.frames_mapped);
  EXPECT_EQ(std::filesystem::last_write_time(job.output), written);
  // It must still be the map of this drive and of these settings.
  BrokenDrive recalibrated;
  recalibrated.editable_info().calibration.cameras[0].fx += 1;
  EXPECT_THROW(map_drive(recalibrated, job, {}), InputError);
  job.hold_out = HoldOut::parse("4:1");
  EXPECT_THROW(map_drive(drive_, job, {}), InputError);
}

TEST_F(MapDriveResume, WithAnImuTheMapIsTheSameAtAnyThreadsAndWhenResumed) {
  const Twist velocity = (Twist() << 0.02, 0, 0.3, 6, 0.5, 0).finished();
  RawDrive drive(6, velocity);
  ImuData& imu = drive.editable_info().imu.emplace();
  const TimeNs begin = *drive.stamp(0);
  for (int i = -50; i < 150; ++i) {
    const RigidMotion T = exp_se3(0.005 * i * velocity);
    const Eigen::Vector3d acceleration_lidar =
        velocity.head<3>().cross(Eigen::Vector3d(velocity.tail<3>()));
    imu.samples.push_back(
        {begin + i * kNsPerSecond / 200, velocity.head<3>(),
         acceleration_lidar + T.linear().transpose() * Eigen::Vector3d(0, 0, 9.81)});
  }
  MapJob job = this->job();
  job.checkpoint_frames = 1;
  std::vector<std::string> digests;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    map_drive(drive, job, {});
    digests.push_back(digest());
  }
  for (const FrameRecord& record : MapReader(job.output).frames()) {
    EXPECT_TRUE(record.motion && record.motion->path) << record.index;
    const RigidMotion error =
        drive.T_local_lidar[std::size_t(record.index)].inverse() * record.T_local_lidar;
    EXPECT_LT(error.translation().norm(), 0.03) << record.index;
  }
  for (int frames = 1; frames <= 4; ++frames) {
    std::stop_source stop;
    MapJob part = job;
    part.overlap = false;
    part.stop = stop.get_token();
    map_drive(drive, part, [&](const RunProgress& progress) {
      if (progress.done == frames) stop.request_stop();
    });
    part.stop = {};
    part.resume = true;
    map_drive(drive, part, {});
    digests.push_back(digest());
  }
  EXPECT_THAT(digests, testing::Each(digests.front()));
}

}  // namespace fovea::map_drive_resume_test
