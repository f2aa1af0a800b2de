#include "fovea/evaluation/training_reach.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/evaluation/test_scene.h"

namespace fovea::training_reach_test {

using testing::ElementsAre;
using testing::Pair;

TEST(ScoredBlocks, EndAtMappedFrames) {
  std::vector<FrameRecord> frames(10);
  for (int i = 0; i < 10; ++i) frames[i].index = i;
  std::vector<PlacedFrame> scored;
  for (const int index : {1, 2, 4, 6, 7}) {
    frames[index].status = FrameStatus::kHeldOut;
    scored.push_back({index, {}, {}});
  }
  frames[5].status = FrameStatus::kSkipped;
  EXPECT_THAT(scored_blocks(scored, frames), ElementsAre(Pair(1, 2), Pair(4, 7)));
  EXPECT_TRUE(scored_blocks({}, frames).empty());
}

TEST(TrainingReach, IsTheWhiteZoneInView) {
  std::vector<FrameRecord> frames(2);
  frames[1].status = FrameStatus::kHeldOut;  // at the same place, but no help
  frames[1].T_local_lidar = Eigen::Translation3d(10, 0, 0) * RigidMotion::Identity();
  const std::vector<Eigen::Vector3f> points = {{2, 0, 0},  {5, 0, 0},  {14, 0, 0},
                                               {16, 0, 0}, {-5, 0, 0}, {5, 5, 0}};
  const Eigen::Vector3d origin(1, 0, 0);  // so that the points lie 1 m farther on
  const TrainingReach reach(frames, {forward_camera()});
  EXPECT_THAT(reach.reached(points, origin, {8, 0, 0}), ElementsAre(0, 1, 0, 0, 0, 0));
  const TrainingReach all_round(frames, {});
  EXPECT_THAT(all_round.reached(points, {0, 0, 0}, {8, 0, 0}), ElementsAre(0, 1, 1, 0, 1, 1));
  EXPECT_THAT(all_round.reached(points, {0, 0, 0}, {40, 0, 0}), ElementsAre(0, 0, 0, 0, 0, 0));
}

TEST(TrainingReach, ACameraWithoutImageSawNothing) {
  std::vector<FrameRecord> frames(1);
  frames[0].count_missing_image(7);
  const std::vector<Eigen::Vector3f> points = {{5, 0, 0}};
  Camera camera = forward_camera();
  camera.index = 7;
  EXPECT_THAT(TrainingReach(frames, {camera}).reached(points, {0, 0, 0}, {8, 0, 0}),
              ElementsAre(0));
  camera.index = 8;
  EXPECT_THAT(TrainingReach(frames, {camera}).reached(points, {0, 0, 0}, {8, 0, 0}),
              ElementsAre(1));
}

}  // namespace fovea::training_reach_test
