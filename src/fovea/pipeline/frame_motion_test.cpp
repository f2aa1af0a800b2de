#include "fovea/pipeline/frame_motion.h"

#include <gtest/gtest.h>

namespace fovea::frame_motion_test {

/// Forward at 8 m/s while turning left: a constant twist.
const Twist kTwist = (Twist() << 0, 0, 0.2, 8, 0, 0).finished();

RigidMotion pose_at(double s) { return exp_se3(s * kTwist); }

/// A drive with only stamps, a tenth of a second apart.
class Stamps : public FrameSource {
 public:
  explicit Stamps(bool with_navigation) {
    info_.begin = 10;
    info_.end = 20;
    info_.sweep.period = 0.1;
    if (!with_navigation) return;
    std::vector<StampedPose> poses;
    for (int k = 0; k < 30; ++k)
      poses.push_back({from_seconds(0.1 * k + 0.02), pose_at(0.1 * k + 0.02)});
    info_.navigation.emplace(poses);
  }
  const DriveInfo& info() const override { return info_; }
  LoadedFrame load(int index) const override {
    return SkippedFrame{index, SkipReason::kMissingScan, ""};
  }
  std::optional<TimeNs> stamp(int index) const override {
    if (index == 13) return std::nullopt;
    return from_seconds(0.1 * index);
  }

 private:
  DriveInfo info_;
};

void expect_motion(const std::optional<FrameMotion>& motion, double s) {
  ASSERT_TRUE(motion);
  EXPECT_LT((motion->sweep.velocity - kTwist).norm(), 1e-6);
  EXPECT_TRUE(motion->T_local_lidar.isApprox(pose_at(s), 1e-9));
}

TEST(FrameMotion, KnownByNavigation) {
  const Stamps drive(true);
  expect_motion(known_motion(drive, {}, 12), 1.2);
  EXPECT_FALSE(known_motion(drive, {}, 13));  // no stamp
}

TEST(FrameMotion, KnownByThePosesGiven) {
  const Stamps drive(false);
  std::vector<RigidMotion> given;
  for (int i = 10; i < 20; ++i) given.push_back(pose_at(0.1 * i));
  for (const int index : {10, 11, 19})
    expect_motion(known_motion(drive, given, index), 0.1 * index);
  EXPECT_FALSE(known_motion(drive, given, 14));  // the frame before it has no stamp
  EXPECT_FALSE(known_motion(drive, {}, 12));
}

TEST(FrameMotion, OfTheLatestMappedFrame) {
  const auto record = [](int index) {
    FrameRecord r;
    r.index = index;
    r.stamp = from_seconds(0.1 * index);
    r.T_local_lidar = pose_at(0.1 * index);
    return r;
  };
  EXPECT_FALSE(mapped_motion(record(10), std::nullopt));  // nothing to compare with
  std::optional<FrameRecord> before = record(10);
  FrameRecord latest = record(11);
  expect_motion(mapped_motion(latest, before), 1.1);
  // The motion of its motion compensation comes first.
  latest.motion = SweepMotion{2 * kTwist, kTwist};
  EXPECT_EQ(mapped_motion(latest, before)->sweep, *latest.motion);
  latest.motion.reset();
  before->status = FrameStatus::kSkipped;
  EXPECT_FALSE(mapped_motion(latest, before));
}

}  // namespace fovea::frame_motion_test
