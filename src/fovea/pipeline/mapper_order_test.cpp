// The same map at any number of threads, with tracking ahead, and after an interruption.
#include <gtest/gtest.h>

#include <tuple>

#include "fovea/core/parallel.h"
#include "fovea/pipeline/mapper.h"
#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::mapper_order_test {

TEST(Mapper, SameMapAtAnyThreadCount) {
  const auto run = [](int threads) {
    const ThreadLimit limit(threads);
    Mapper mapper(street().info(), {}, PoseSource::kRefine);
    map_frames(mapper, street(), 0, 3);
    return points_of(mapper.map());
  };
  const auto one = run(1), two = run(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].p_local, two[i].p_local);
    ASSERT_EQ(one[i].color, two[i].color);
  }
}

// Mapping sees submaps as they were at its frame, however far tracking is ahead.
TEST(Mapper, TrackingAheadChangesNothing) {
  SyntheticDrive drive(street_scene(), 10, 1.3);
  std::vector<StampedPose> poses = drive.info().navigation->poses();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].T_local_body.translation().y() += 0.02 * double(i % 2);  // submaps move
  }
  drive.editable_info().navigation = Trajectory(poses);
  MapperOptions options;
  options.fusion.submap_duration = 0.25;
  Mapper stepwise(drive.info(), options, PoseSource::kRefine);
  const auto records = map_frames(stepwise, drive, 0, 10, 3);

  Mapper ahead(drive.info(), options, PoseSource::kRefine);
  std::vector<TrackedScan> tracked;
  for (int i = 0; i < 10; ++i) {
    tracked.push_back(ahead.track(std::get<Frame>(drive.load(i)), {.held_out = i == 3}));
  }
  for (int i = 0; i < 10; ++i) {
    const FrameRecord record = record_of(
        ahead.map_frame(std::get<Frame>(drive.load(i)), std::move(tracked[std::size_t(i)])));
    EXPECT_EQ(record.figures, records[std::size_t(i)].figures) << i;
    if (i % 2 == 0)
      ahead.apply_deferred_mapping();  // where it is not called, the next frame does it
  }
  EXPECT_GT(ahead.map().submaps().size(), 2u);
  expect_same_maps(stepwise.map(), ahead.map());
}

TEST(Mapper, ResumedRunEqualsAnUninterruptedOne) {
  // Targets are all scans, some, or the first alone.
  for (const auto& [keyframe_distance, keyframe_overlap, max_keyframes] : {std::tuple(0.0, 0.8, 20),
                                                                           {1.5, 0.8, 20},
                                                                           {1.5, 0.8, 1},
                                                                           {1000.0, 0.8, 20},
                                                                           {1000.0, 0.99, 20}}) {
    MapperOptions options;
    options.refinement.local_map.keyframe_distance = keyframe_distance;
    options.refinement.local_map.keyframe_overlap = keyframe_overlap;
    options.refinement.local_map.max_keyframes = max_keyframes;
    options.fusion.submap_duration = 0.25;  // several submaps
    Mapper whole(street().info(), options, PoseSource::kRefine);
    const auto records = map_frames(whole, street(), 0, 7, 3);

    Mapper first(street().info(), options, PoseSource::kRefine);
    const auto before = map_frames(first, street(), 0, 4, 3);
    Mapper second(street().info(), options, PoseSource::kRefine);
    second.resume(first.map(), before, street());
    const auto after = map_frames(second, street(), 4, 7, 3);

    EXPECT_EQ(records[6].T_local_lidar.matrix(), after[2].T_local_lidar.matrix());
    expect_same_maps(whole.map(), second.map());
  }
}

// A file may come from anybody.
TEST(Mapper, ResumesFromRecordsThatLackAFigure) {
  Mapper first(street().info(), {}, PoseSource::kRefine);
  auto records = map_frames(first, street(), 0, 3);
  ASSERT_EQ(records[2].figures.erase("registration_points"), 1u);
  Mapper second(street().info(), {}, PoseSource::kRefine);
  second.resume(first.map(), records, street());
  EXPECT_EQ(map_frames(second, street(), 3, 4)[0].status, FrameStatus::kMapped);
}

}  // namespace fovea::mapper_order_test
