// The drive's stages side by side: the same map as one after the other, and the same errors.
#include "fovea/pipeline/map_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../tests/temporary_folder.h"
#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/mapper_test_support.h"

namespace fovea {
namespace {

/// A drive with moves of its submaps; one frame may not be readable.
class BrokenDrive : public SyntheticDrive {
 public:
  int error_at = -1;
  BrokenDrive() : SyntheticDrive(street_scene(), 8, 0.8) {}
  FrameResult load(int index) const override {
    if (index == error_at) throw InputError("cannot be read", "frame", "repair it");
    return SyntheticDrive::load(index);
  }
};

class MapDrive : public testing::Test {
 protected:
  MapJob job() const {
    MapJob job;
    job.output = folder_ / "out.fovea";
    job.hold_out = HoldOut::parse("8:2");
    job.options.fusion.submap_duration = 0.25;  // several submaps, which navigation moves
    job.force = true;
    return job;
  }
  std::string digest() const { return MapReader(folder_ / "out.fovea").digest(); }

  BrokenDrive drive_;
  TemporaryFolder folder_;
};

TEST_F(MapDrive, OverlapChangesNothing) {
  std::vector<std::string> digests;
  for (const auto& [threads, overlap] :
       {std::pair(2, false), {1, true}, {2, true}, {4, true}, {4, true}}) {
    const ThreadLimit limit(threads);
    MapJob job = this->job();
    job.overlap = overlap;
    std::vector<int> told;
    map_drive(drive_, job, [&](const MapProgress& progress) {
      told.push_back(progress.latest->index);
      EXPECT_EQ(progress.done, static_cast<int>(told.size()));
    });
    EXPECT_EQ(told, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    digests.push_back(digest());
    EXPECT_EQ(digests.back(), digests.front()) << threads << " threads";
  }
  EXPECT_GT(MapReader(job().output).submaps().size(), 1u);
}

TEST_F(MapDrive, AnInterruptedRunGoesOnToTheSameMap) {
  const ThreadLimit limit(2);
  map_drive(drive_, job(), {});
  const std::string whole = digest();

  std::stop_source stop;
  MapJob job = this->job();
  job.stop = stop.get_token();
  const MapSummary cut = map_drive(drive_, job, [&](const MapProgress& progress) {
    if (progress.done == 3) stop.request_stop();
  });
  ASSERT_TRUE(cut.interrupted);
  EXPECT_LE(cut.frames_mapped + cut.frames_held_out, 3 + 1);  // one may have been tracked
  job.stop = {};
  job.resume = true;
  EXPECT_FALSE(map_drive(drive_, job, {}).interrupted);
  EXPECT_EQ(digest(), whole);
}

TEST_F(MapDrive, AnErrorEndsTheRunAndLeavesNothing) {
  drive_.error_at = 4;
  for (const bool overlap : {false, true}) {
    MapJob job = this->job();
    job.overlap = overlap;
    int done = 0;
    EXPECT_THROW(map_drive(drive_, job, [&](const MapProgress&) { ++done; }), InputError);
    EXPECT_EQ(done, 4);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
    // One of the last stage, while the others are at work.
    EXPECT_THROW(map_drive(drive_, job, [](const MapProgress&) { throw OutputError("", "", ""); }),
                 OutputError);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  }
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
  const MapSummary summary = map_drive(drive_, job, [&](const MapProgress& progress) {
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
  std::vector<double> latencies, stages;
  map_drive(drive_, job, [&](const MapProgress& progress) {
    const auto& ms = progress.latest->milliseconds;
    latencies.push_back(ms.at("frame"));
    double sum = 0;
    for (const auto& [stage, time] : ms) {
      if (stage != "frame" && stage != "decode" && stage != "calibration") sum += time;
    }
    stages.push_back(sum);
  });
  for (std::size_t i = 0; i < latencies.size(); ++i) EXPECT_GE(latencies[i], stages[i]);
  // All arrive in the first microseconds, and end one after the other.
  EXPECT_THAT(latencies, testing::WhenSorted(testing::ElementsAreArray(latencies)));
}

}  // namespace
}  // namespace fovea
