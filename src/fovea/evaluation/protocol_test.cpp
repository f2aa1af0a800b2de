#include "fovea/evaluation/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/errors.h"
#include "fovea/evaluation/test_scene.h"

namespace fovea::protocol_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class ProtocolTest : public testing::Test {
 protected:
  ProtocolTest() { map_ = wall_map(WallScene::map(0.5), 16); }

  std::vector<int> selected(Protocol protocol, std::string_view hold_out = "") const {
    std::vector<int> frames;
    for (const PlacedFrame& placed : select(protocol, hold_out)) frames.push_back(placed.index);
    return frames;
  }
  std::vector<PlacedFrame> select(Protocol protocol, std::string_view hold_out = "") const {
    return select_frames(map_, drive_, {protocol, {}, HoldOut::parse(hold_out)});
  }

  ScoredMap map_;
  WallDrive drive_{16, {forward_camera(2), forward_camera(3)}};
};

TEST_F(ProtocolTest, NamesGoBothWays) {
  for (const char* name : {"in-sample", "in-sample-nav", "held-out", "cross-camera"}) {
    EXPECT_STREQ(to_string(parse_protocol(name)), name);
    EXPECT_STRNE(explanation(parse_protocol(name)), "");
  }
  EXPECT_THROW(parse_protocol("heldout"), ConfigError);
}

TEST_F(ProtocolTest, InSampleTakesTheMappedFrames) {
  map_.frames[2].status = FrameStatus::kSkipped;
  EXPECT_THAT(selected(Protocol::kInSample),
              ElementsAre(0, 1, 3, 5, 6, 7, 8, 9, 10, 11, 13, 14, 15));
  EXPECT_THAT(selected(Protocol::kInSample, "3-9,11-14"), ElementsAre(0, 1, 10, 15));
}

TEST_F(ProtocolTest, HeldOutTakesTheHeldOutFrames) {
  EXPECT_THAT(selected(Protocol::kHeldOut), ElementsAre(4, 12));
  EXPECT_THAT(selected(Protocol::kHeldOut, "12-12"), ElementsAre(12));
  map_.frames[12].status = FrameStatus::kSkipped;
  EXPECT_THAT(selected(Protocol::kHeldOut), ElementsAre(4));
}

TEST_F(ProtocolTest, HeldOutRefusesFramesThatTheMapWasBuiltWith) {
  EXPECT_THAT([&] { selected(Protocol::kHeldOut, "4-5"); },
              ThrowsMessage<InputError>(HasSubstr("frame 5")));
  map_.points_local.frame[7] = 12;  // the record says held out, a point says otherwise
  EXPECT_THAT([&] { selected(Protocol::kHeldOut); },
              ThrowsMessage<InputError>(HasSubstr("frame 12")));
  EXPECT_THAT(selected(Protocol::kHeldOut, "4-4"), ElementsAre(4));
}

TEST_F(ProtocolTest, HeldOutNeedsAHeldOutFrame) {
  for (FrameRecord& record : map_.frames) record.status = FrameStatus::kMapped;
  EXPECT_THROW(selected(Protocol::kHeldOut), InputError);
}

TEST_F(ProtocolTest, ACloudMustBeToldWhatWasHeldOut) {
  map_.statuses_known = false;
  for (FrameRecord& record : map_.frames) record.status = FrameStatus::kMapped;
  EXPECT_THROW(selected(Protocol::kHeldOut), InputError);
  EXPECT_THAT(selected(Protocol::kHeldOut, "8:4"), ElementsAre(4, 12));
  map_.points_local.frame[3] = 4;
  EXPECT_THROW(selected(Protocol::kHeldOut, "8:4"), InputError);
}

TEST_F(ProtocolTest, PosesAreTheRefinedOnes) {
  EXPECT_NEAR(select(Protocol::kHeldOut)[1].T_local_lidar.translation().x(), 2.4, 1e-12);
}

TEST_F(ProtocolTest, NavigationPosesWhereAskedFor) {
  EXPECT_THAT([&] { select(Protocol::kInSampleNavigation); },
              ThrowsMessage<InputError>(HasSubstr("no navigation poses")));
  map_.frames[3].T_local_lidar_navigation = RigidMotion(Eigen::Translation3d(9, 9, 9));
  const std::vector<PlacedFrame> frames = select(Protocol::kInSampleNavigation);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].index, 3);
  EXPECT_EQ(frames[0].T_local_lidar.translation(), Eigen::Vector3d(9, 9, 9));
}

TEST_F(ProtocolTest, VelocityIsTheMapsOrElseThatOfThePoses) {
  map_.frames[4].motion = SweepMotion{Twist::Constant(0.5), Twist::Constant(0.1)};
  const std::vector<PlacedFrame> frames = select(Protocol::kHeldOut);
  EXPECT_EQ(frames[0].motion, map_.frames[4].motion);
  Twist forwards = Twist::Zero();
  forwards(3) = 2;  // 0.2 m in 0.1 s
  ASSERT_TRUE(frames[1].motion.has_value());
  EXPECT_TRUE(frames[1].motion->velocity.isApprox(forwards, 1e-9));
}

TEST_F(ProtocolTest, VelocityFromPosesTurnsWithTheVehicle) {
  // Driving along local y, facing it: forwards in the LiDAR's own frame.
  for (FrameRecord& record : map_.frames) {
    record.T_local_lidar = Eigen::Translation3d(0, 0.5 * record.index, 0) *
                           Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  }
  Twist forwards = Twist::Zero();
  forwards(3) = 5;
  EXPECT_TRUE(select(Protocol::kHeldOut)[0].motion->velocity.isApprox(forwards, 1e-9));
}

TEST_F(ProtocolTest, CamerasAreTheMapsUnlessOthersAreAskedFor) {
  ProtocolOptions options;
  EXPECT_THAT(select_cameras(map_, drive_.info(), options), ElementsAre(0u));
  options.cameras = {3, 2, 3};
  EXPECT_THAT(select_cameras(map_, drive_.info(), options), ElementsAre(1u, 0u));
  options.cameras = {1};
  EXPECT_THROW(select_cameras(map_, drive_.info(), options), ConfigError);
  options.cameras = {};
  map_.cameras = {};
  EXPECT_THAT(select_cameras(map_, drive_.info(), options), ElementsAre(0u, 1u));
}

TEST_F(ProtocolTest, CrossCameraScoresHeldOutFramesInOtherCameras) {
  EXPECT_THAT(selected(Protocol::kCrossCamera), ElementsAre(4, 12));
  EXPECT_THROW(selected(Protocol::kCrossCamera, "4-5"), InputError);
  ProtocolOptions options;
  options.protocol = Protocol::kCrossCamera;
  options.cameras = {3};
  EXPECT_THAT(select_cameras(map_, drive_.info(), options), ElementsAre(1u));
  options.cameras = {3, 2};
  EXPECT_THAT([&] { select_cameras(map_, drive_.info(), options); },
              ThrowsMessage<ConfigError>(HasSubstr("camera 2")));
  options.cameras = {};
  EXPECT_THROW(select_cameras(map_, drive_.info(), options), ConfigError);
}

}  // namespace fovea::protocol_test
