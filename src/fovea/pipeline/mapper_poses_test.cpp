// Poses of the mapper: registration, navigation that fails, given poses.
#include <gtest/gtest.h>

#include "fovea/pipeline/drive_log.h"
#include "fovea/pipeline/mapper.h"
#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::mapper_poses_test {

// The registration is given a wrong speed (navigation scaled by 0.9) and must find the true steps.
TEST(Mapper, RefinementCorrectsTheNavigation) {
  const SyntheticDrive drive = street_with_slow_navigation();
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  const auto records = map_frames(mapper, drive, 0, 8);
  const double error =
      (records[7].T_local_lidar.translation() - drive.T_local_lidar[7].translation()).norm();
  EXPECT_LT(error, 0.1);  // navigation is 0.56 m off
  EXPECT_EQ(records[7].note, "");
}

// A camera that sees next to nothing gives next to no map, and the very same poses.
TEST(Mapper, RegistrationUsesWhatNoCameraSees) {
  const auto run = [](int width) {
    SyntheticDrive drive(street_scene(), 4, 0.8);
    drive.editable_info().calibration.cameras[0].width = width;
    Mapper mapper(drive.info(), {}, PoseSource::kRefine);
    const auto records = map_frames(mapper, drive, 0, 4);
    return std::pair(records, mapper.map().size());
  };
  const auto [whole, many] = run(621);
  const auto [slit, few] = run(12);
  EXPECT_LT(few, many / 10);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(whole[i].T_odom_lidar.matrix(), slit[i].T_odom_lidar.matrix());
    EXPECT_EQ(whole[i].figures.at("registration_points"),
              slit[i].figures.at("registration_points"));
    EXPECT_GT(slit[i].figures.at("registration_points"), 1000);
  }
}

TEST(Mapper, WithoutNavigationItStartsFromRest) {
  SyntheticDrive drive(street_scene(), 8, 0.8);
  drive.editable_info().navigation.reset();
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  const auto records = map_frames(mapper, drive, 0, 8);
  const RigidMotion truth = drive.T_local_lidar[0].inverse() * drive.T_local_lidar[7];
  EXPECT_LT((records[7].T_local_lidar.translation() - truth.translation()).norm(), 0.05);
}

/// A drive whose navigation is as `spoil` leaves it; the worst error of a frame's pose.
template <class Spoil>
double worst_error(Spoil&& spoil, std::vector<FrameRecord>* told = nullptr) {
  SyntheticDrive drive(street_scene(), 14, 0.8);
  std::vector<StampedPose> poses = drive.info().navigation->poses();
  spoil(poses);
  drive.editable_info().navigation = Trajectory(poses);
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  DriveLog log;
  for (FrameRecord& record : map_frames(mapper, drive, 0, 14)) log.add(std::move(record));
  std::vector<FrameRecord> records = log.rows(mapper.map(), /*exact=*/true).frames;
  double worst = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const RigidMotion truth = drive.T_local_lidar[0].inverse() * drive.T_local_lidar[i];
    const RigidMotion found = records[0].T_local_lidar.inverse() * records[i].T_local_lidar;
    worst = std::max(worst, (found.translation() - truth.translation()).norm());
  }
  if (told != nullptr) *told = std::move(records);
  return worst;
}

TEST(Mapper, SurvivesNavigationThatJumps) {
  std::vector<FrameRecord> records;
  EXPECT_LT(worst_error(
                [](auto& poses) {
                  for (std::size_t i = 6; i < poses.size(); ++i) {
                    poses[i].T_local_body.translation().y() += 5;
                  }
                },
                &records),
            0.05);
  EXPECT_EQ(records[6].figures.count("navigation_jumped"), 1u);
  EXPECT_NE(records[6].note.find("navigation moves otherwise"), std::string::npos);
  EXPECT_EQ(records[7].figures.count("navigation_jumped"), 0u);
}

TEST(Mapper, SurvivesNavigationThatFreezes) {
  EXPECT_LT(worst_error([](auto& poses) {
              for (std::size_t i = 6; i < poses.size(); ++i) {
                poses[i].T_local_body = poses[5].T_local_body;
              }
            }),
            0.05);
}

TEST(Mapper, SurvivesNavigationThatEnds) {
  EXPECT_LT(worst_error([](auto& poses) { poses.resize(5); }), 0.05);
}

TEST(Mapper, SurvivesScansWithHalfTheirBeams) {
  SyntheticDrive drive(street_scene(), 12, 0.8);
  drive.editable_info().navigation.reset();
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  double worst = 0;
  for (int i = 0; i < 12; ++i) {
    drive.beams = i % 3 == 2 ? 24 : 48;
    const FrameResult result = mapper.process(std::get<Frame>(drive.load(i)));
    const RigidMotion truth =
        drive.T_local_lidar[0].inverse() * drive.T_local_lidar[std::size_t(i)];
    worst =
        std::max(worst, (result.poses.T_local_lidar.translation() - truth.translation()).norm());
    EXPECT_EQ(result.note, "") << i;
  }
  EXPECT_LT(worst, 0.08);
}

TEST(Mapper, AVehicleThatStandsStaysWhereItIs) {
  SyntheticDrive drive(street_scene(), 30, 0);
  for (RigidMotion& T : drive.T_local_lidar) T = RigidMotion::Identity();
  drive.editable_info().navigation.reset();
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  const auto records = map_frames(mapper, drive, 0, 30);
  EXPECT_LT(records.back().T_local_lidar.translation().norm(), 0.005);
  EXPECT_EQ(mapper.map().submaps().size(), 1u);
}

TEST(Mapper, WhereGivenPosesEndScansAreRegistered) {
  SyntheticDrive drive(street_scene(), 10, 0.8);
  drive.editable_info().navigation.reset();
  Mapper mapper(drive.info(), {}, PoseSource::kGivenFirst);
  std::vector<FrameRecord> records;
  for (int i = 0; i < 10; ++i) {
    const auto given = i < 5 ? std::optional(drive.T_local_lidar[std::size_t(i)]) : std::nullopt;
    records.push_back(
        record_of(mapper.process(std::get<Frame>(drive.load(i)), {.given_pose = given})));
  }
  EXPECT_EQ(records[4].T_local_lidar.matrix(), drive.T_local_lidar[4].matrix());
  EXPECT_LT((records[9].T_local_lidar.translation() - drive.T_local_lidar[9].translation()).norm(),
            0.05);
}

TEST(Mapper, AScanOfWhatIsNotInTheTargetBecomesPartOfIt) {
  const auto last_pose = [](double distance, double overlap) {
    MapperOptions options;
    options.refinement.local_map.keyframe_distance = distance;
    options.refinement.local_map.keyframe_overlap = overlap;
    Mapper mapper(street().info(), options, PoseSource::kRefine);
    return map_frames(mapper, street(), 0, 5).back().T_odom_lidar.matrix();
  };
  const auto first_alone = last_pose(1000, 0), all = last_pose(0, 0);
  EXPECT_NE(first_alone, all);
  EXPECT_EQ(last_pose(1000, 1), all);
  EXPECT_EQ(last_pose(1000, 0.1), first_alone);
}

TEST(Mapper, ARegisteredPoseHasACovariance) {
  Mapper mapper(street().info(), {}, PoseSource::kRefine);
  for (int i = 0; i < 4; ++i) {
    const FrameResult result = mapper.process(std::get<Frame>(street().load(i)));
    const auto& covariance = result.tracking.registration.value().covariance;
    ASSERT_EQ(covariance.has_value(), i > 0);  // the first scan has no target
    if (!covariance) continue;
    EXPECT_GT(covariance->diagonal().minCoeff(), 0);
    EXPECT_LT(std::sqrt((*covariance)(4, 4)), 0.1);  // m, across the street
  }
}

}  // namespace fovea::mapper_poses_test
