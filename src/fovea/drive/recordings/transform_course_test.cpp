#include "fovea/drive/recordings/transform_course.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fovea::transform_course_test {

constexpr TimeNs kStep = kNsPerSecond / 100;

QuaternionMotion some_motion(double seed) {
  return exp_se3((Twist() << 0.3 * seed, -0.2, 0.1, seed, 2, -0.5 * seed).finished());
}

ros::Transform transform(const std::string& parent, const std::string& child, TimeNs time,
                         double seed) {
  return {{time, parent}, child, some_motion(seed)};
}

void add(TransformTree& tree, const ros::Transform& t) {
  tree.add(t.header.frame, t.child_frame, t.header.stamp, t.T_header_child, /*fixed=*/false);
}

void expect_same(const std::vector<RecordedPose>& poses,
                 const std::vector<TransformTree::TimedMotion>& course) {
  ASSERT_EQ(poses.size(), course.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].time, course[i].time);
    EXPECT_EQ(poses[i].T_world_body.translation, course[i].T_a_b.translation);
    EXPECT_EQ(poses[i].T_world_body.rotation.coeffs(), course[i].T_a_b.rotation.coeffs());
  }
}

TEST(TransformCourse, GivesThePosesOfAWholeRecording) {
  // `odom` in `map` comes every 20th time, and is interpolated: its poses wait for it.
  std::vector<ros::Transform> all;
  for (int i = 1; i <= 81; ++i) {
    if (i % 10 == 1) all.push_back(transform("map", "odom", i * kStep, 0.1 * i));
    all.push_back(transform("odom", "base_link", i * kStep, 0.01 * i));
  }
  TransformTree whole, first;
  for (std::size_t i = 0; i < all.size(); ++i) {
    add(whole, all[i]);
    if (i < 40) add(first, all[i]);
  }
  TransformCourse course(first, "map", "base_link");
  std::vector<RecordedPose> poses;
  for (const ros::Transform& t : all) {
    for (const RecordedPose& pose : course.add({t})) poses.push_back(pose);
  }
  expect_same(poses, whole.course("map", "base_link"));
}

TEST(TransformCourse, WaitsATenthOfASecondForAFrameThatStoppedComing) {
  TransformTree tree;
  for (int i = 1; i <= 3; ++i) {
    add(tree, transform("map", "odom", i * kStep, i));
    add(tree, transform("odom", "base_link", i * kStep, i));
  }
  TransformCourse course(tree, "map", "base_link");
  EXPECT_EQ(course.add({}).size(), 3u);
  EXPECT_TRUE(course.add({transform("odom", "base_link", 4 * kStep, 4)}).empty());
  EXPECT_TRUE(course.add({transform("odom", "base_link", 13 * kStep, 5)}).empty());
  const auto late = course.add({transform("odom", "base_link", 14 * kStep, 6)});
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late[0].time, 4 * kStep);
  EXPECT_TRUE(
      late[0].T_world_body.matrix().isApprox((some_motion(3) * some_motion(4)).matrix(), 1e-12));
}

TEST(TransformCourse, GivesAPoseOnce) {
  TransformTree tree;
  for (int i = 1; i <= 2; ++i) add(tree, transform("odom", "base_link", i * kStep, i));
  TransformCourse course(tree, "odom", "base_link");
  EXPECT_EQ(course.add({}).size(), 2u);
  EXPECT_TRUE(course.add({transform("odom", "base_link", 2 * kStep, 9)}).empty());
  EXPECT_TRUE(course.add({transform("odom", "base_link", kStep, 9)}).empty());
  EXPECT_TRUE(course.add({transform("base_link", "wheel", 3 * kStep, 9)}).empty());
  EXPECT_EQ(course.add({transform("odom", "base_link", 3 * kStep, 3)}).size(), 1u);
}

std::vector<TimeNs> times_of(const std::vector<RecordedPose>& poses) {
  std::vector<TimeNs> times;
  for (const RecordedPose& pose : poses) times.push_back(pose.time);
  return times;
}

/// The times of the poses that `odom` to `base_link` gives, one message at a time.
std::vector<TimeNs> times_of_poses(const std::vector<TimeNs>& stamps) {
  TransformTree tree;
  for (int i = 1; i <= 2; ++i) add(tree, transform("odom", "base_link", stamps[i - 1], i));
  TransformCourse course(tree, "odom", "base_link");
  std::vector<TimeNs> times = times_of(course.add({}));
  for (std::size_t i = 2; i < stamps.size(); ++i) {
    for (const TimeNs time :
         times_of(course.add({transform("odom", "base_link", stamps[i], 0.1 * double(i))}))) {
      times.push_back(time);
    }
  }
  return times;
}

constexpr TimeNs kStart = 1000 * kNsPerSecond;

TEST(TransformCourse, ContinuesAfterTheClockGoesBack) {
  const std::vector<TimeNs> stamps = {kStart,
                                      kStart + kStep,
                                      kStart + 2 * kStep,
                                      kStart / 2,
                                      kStart / 2 + kStep,
                                      kStart / 2 + 2 * kStep,
                                      kStart + 3 * kStep,
                                      kStart + 4 * kStep};
  EXPECT_EQ(times_of_poses(stamps), stamps);
}

TEST(TransformCourse, LeavesOutASingleStampFarFromTheOthers) {
  for (const TimeNs far : {kStart / 2, 2 * kStart}) {
    const std::vector<TimeNs> stamps = {kStart, kStart + kStep, far, kStart + 2 * kStep,
                                        kStart + 3 * kStep};
    std::vector<TimeNs> expected = stamps;
    expected.erase(expected.begin() + 2);
    EXPECT_EQ(times_of_poses(stamps), expected);
  }
}

TEST(TransformCourse, AFarStampAmongTheFirstBlocksNoPose) {
  const std::vector<TimeNs> stamps = {kStart, 2 * kStart, kStart + kStep, kStart + 2 * kStep};
  EXPECT_EQ(times_of_poses(stamps), stamps);
}

TEST(TransformCourse, NoOldTransformOfAnotherFrameCountsAfterTheClockWentBack) {
  TransformTree tree;
  for (int i = 1; i <= 2; ++i) {
    add(tree, transform("map", "odom", kStart + i * kStep, i));
    add(tree, transform("odom", "base_link", kStart + i * kStep, i));
  }
  TransformCourse course(tree, "map", "base_link");
  EXPECT_EQ(course.add({}).size(), 2u);
  const TimeNs time = kStart / 2;
  course.add({transform("map", "odom", time, 0.7), transform("odom", "base_link", time, 0.3)});
  const auto poses = course.add({transform("odom", "base_link", time + kStep, 0.4),
                                 transform("map", "odom", time + kStep, 0.8)});
  ASSERT_EQ(times_of(poses), (std::vector<TimeNs>{time, time + kStep}));
  EXPECT_TRUE(poses[0].T_world_body.matrix().isApprox(
      (some_motion(0.7) * some_motion(0.3)).matrix(), 1e-12));
  EXPECT_TRUE(poses[1].T_world_body.matrix().isApprox(
      (some_motion(0.8) * some_motion(0.4)).matrix(), 1e-12));
}

TEST(TransformCourse, MemoryIsBoundedWhileTheNearestFrameDoesNotCome) {
  for (const TimeNs step : {kStep, kNsPerSecond / 100'000}) {
    TransformTree tree;
    for (int i = 1; i <= 2; ++i) {
      add(tree, transform("map", "odom", kStart + i * step, i));
      add(tree, transform("odom", "base_link", kStart + i * step, i));
    }
    TransformCourse course(tree, "map", "base_link");
    course.add({});
    std::vector<ros::Transform> odom;
    for (int i = 3; i <= 20'000; ++i) {
      odom.push_back(transform("map", "odom", kStart + i * step, 0.1));
    }
    course.add(odom);
    const std::size_t most =
        std::min(TransformCourse::kMaxTransforms, std::size_t(TransformCourse::kMaxAge / step) + 1);
    EXPECT_EQ(course.size(), most + 1);
    // The nearest frame continues.
    const TimeNs time = kStart + 20'000 * step;
    const auto poses = course.add({transform("odom", "base_link", time - step, 0.2),
                                   transform("odom", "base_link", time, 0.2)});
    EXPECT_EQ(poses.size(), 2u);
    EXPECT_LE(course.size(), 2u);
  }
}

}  // namespace fovea::transform_course_test
