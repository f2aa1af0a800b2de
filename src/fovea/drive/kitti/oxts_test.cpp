#include "fovea/drive/kitti/oxts.h"

#include <gtest/gtest.h>

#include <numbers>

#include "../../../../tests/kitti_test_drive.h"

namespace fovea::oxts_test {

// 24 more fields, most of which are not used but must be there.
const std::string kRest = " 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 4 7 4 4 0\n";

std::string why(const std::string& text) {
  const auto result = parse_oxts(text);
  const auto* reason = std::get_if<std::string>(&result);
  return reason != nullptr ? *reason : "";
}

TEST(Oxts, ReadsPositionAndAttitude) {
  const auto result = parse_oxts("49.009 8.437 114.4 0.07 0.0015 -0.26" + kRest);
  ASSERT_TRUE(std::holds_alternative<OxtsRecord>(result));
  const auto& record = std::get<OxtsRecord>(result);
  EXPECT_EQ(record.position.latitude, 49.009);
  EXPECT_EQ(record.position.longitude, 8.437);
  EXPECT_EQ(record.position.altitude, 114.4);
  EXPECT_EQ(record.roll, 0.07);
  EXPECT_EQ(record.pitch, 0.0015);
  EXPECT_EQ(record.yaw, -0.26);
  EXPECT_EQ(record.position_accuracy, 18);
  EXPECT_EQ(record.satellites, 7);
}

TEST(Oxts, ARecordThatStatesNoQualityHasNoNumberOfSatellites) {
  const std::string velocities = " 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17";
  const auto satellites = [&](const std::string& quality) {
    return std::get<OxtsRecord>(parse_oxts("49 8 100 0 0 0" + velocities + quality)).satellites;
  };
  EXPECT_EQ(satellites(" 0 0 0 0 0 0 0"), std::nullopt);
  EXPECT_EQ(satellites(" 0 0 4 0 0 0 0"), 0);
  EXPECT_EQ(satellites(" 3.2 0 0 0 0 0 0"), 0);
  EXPECT_EQ(satellites(" 0.1 0.1 4 9 5 5 6"), 9);
}

/// A record that is turned so, with a velocity in its level frame and rates about its own axes.
OxtsRecord moving(const std::string& angles, const std::string& v_level, const std::string& rates) {
  return std::get<OxtsRecord>(parse_oxts("49 8 100 " + angles + " 1 2 " + v_level +
                                         " 0 0 9.8 0 0 9.8 " + rates +
                                         " 0 0 0 0.1 0.02 4 7 4 4 0"));
}

TEST(Oxts, VelocityIsTheImusInItsOwnFrame) {
  const Twist level = moving("0 0 2", "9 0.5 0.1", "0.01 -0.02 0.3").velocity.value();
  EXPECT_LT((level.head<3>() - Eigen::Vector3d(0.01, -0.02, 0.3)).norm(), 1e-15);
  EXPECT_LT((level.tail<3>() - Eigen::Vector3d(9, 0.5, 0.1)).norm(), 1e-14);
  // Front down by 0.1: going level is going forward and up along the unit's own axes.
  const Twist nodding = moving("0 0.1 2", "9 0 0", "0.01 -0.02 0.3").velocity.value();
  EXPECT_LT((nodding.tail<3>() - Eigen::Vector3d(9 * std::cos(0.1), 0, 9 * std::sin(0.1))).norm(),
            1e-14);
  // Left side up by 0.1: to the left is left and down along its own.
  const Twist rolling = moving("0.1 0 2", "0 1 0", "0.01 -0.02 0.3").velocity.value();
  EXPECT_LT((rolling.tail<3>() - Eigen::Vector3d(0, std::cos(0.1), -std::sin(0.1))).norm(), 1e-14);
}

TEST(Oxts, ZerosAndNonsenseAreNoVelocity) {
  EXPECT_TRUE(moving("0 0 0", "1e-9 0 0", "1e-9 0 0").velocity);
  EXPECT_FALSE(moving("0 0 0", "0 0 0", "0.1 0 0").velocity);
  EXPECT_FALSE(moving("0 0 0", "9 0 0", "0 0 0").velocity);
  EXPECT_FALSE(moving("0 0 0", "201 0 0", "0.1 0 0").velocity);
  EXPECT_FALSE(moving("0 0 0", "1e300 0 0", "0.1 0 0").velocity);
  EXPECT_FALSE(moving("0 0 0", "9 0 0", "0 0 57").velocity);  // degrees
}

TEST(Oxts, SaysWhyARecordCannotBeUsed) {
  EXPECT_EQ(why("49 8 100 0 0 0 1 2 3"), "has 9 numbers, not 30");
  EXPECT_EQ(why(""), "has 0 numbers, not 30");
  EXPECT_EQ(why("49 8 100 0 0 0" + kRest + "1"), "has 31 numbers, not 30");
  EXPECT_EQ(why("nan 8 100 0 0 0" + kRest), "has an entry that is not finite");
  EXPECT_EQ(why("49 8 inf 0 0 0" + kRest), "has an entry that is not finite");
  EXPECT_EQ(why("49 x 100 0 0 0" + kRest), "has an entry that is no number");
  EXPECT_NE(why("91 8 100 0 0 0" + kRest).find("latitude 91"), std::string::npos);
  EXPECT_NE(why("49 188 100 0 0 0" + kRest).find("longitude 188"), std::string::npos);
  EXPECT_NE(why("49 8 1e9 0 0 0" + kRest).find("altitude"), std::string::npos);
  EXPECT_NE(why("49 8 100 0 0 270" + kRest).find("angle 270"), std::string::npos);
  EXPECT_NE(why("49 8 100 0 0 270" + kRest).find("likely degrees"), std::string::npos);
  EXPECT_NE(why("139 35 100 0 0 0" + kRest).find("swapped"), std::string::npos);
  EXPECT_EQ(why("189 35 100 0 0 0" + kRest).find("swapped"), std::string::npos);
  EXPECT_EQ(why("0 0 0 0 0 0" + kRest), "has latitude and longitude 0: no fix");
  EXPECT_EQ(why("0.0001 -0.0004 30 0 0 0" + kRest), "has latitude and longitude 0: no fix");
}

TEST(Oxts, UnreadableFilesAreUnusableRecords) {
  const test::TemporaryFolder folder;
  const auto reason = [&](const std::filesystem::path& file) {
    return std::get<std::string>(read_oxts(file));
  };
  EXPECT_NE(reason(folder.path() / "none.txt").find("No such file"), std::string::npos);
  EXPECT_NE(reason(folder.path()).find("it is a folder"), std::string::npos);
  test::write_text(folder.path() / "a.txt", std::string("\xFF\xFE"
                                                        "4\0",
                                                        4));
  EXPECT_EQ(reason(folder.path() / "a.txt"), "cannot be read: the text is UTF-16");
  test::write_text(folder.path() / "a.txt",
                   "\xEF\xBB\xBF"
                   "49 8.4 100 0 0 0" +
                       kRest);
  EXPECT_TRUE(std::holds_alternative<OxtsRecord>(read_oxts(folder.path() / "a.txt")));
}

TEST(Oxts, AnglesTurnAsTheFormatSays) {
  OxtsRecord record;
  const auto axis = [&](int k) { return Eigen::Vector3d(record.R_enu_imu().col(k)); };
  record.yaw = std::numbers::pi / 2;  // heading north: forward is north, left is west
  EXPECT_LT((axis(0) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((axis(1) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-15);
  record.yaw = 0;
  record.pitch = 0.1;  // front down
  EXPECT_NEAR(axis(0).z(), -std::sin(0.1), 1e-15);
  record.pitch = 0;
  record.roll = 0.1;  // left side up
  EXPECT_NEAR(axis(1).z(), std::sin(0.1), 1e-15);
  record.pitch = 0.2;
  record.yaw = 0.3;  // roll first, then pitch, then yaw: forward keeps out of the roll
  EXPECT_LT((axis(0) - Eigen::Vector3d(std::cos(0.3) * std::cos(0.2), std::sin(0.3) * std::cos(0.2),
                                       -std::sin(0.2)))
                .norm(),
            1e-15);
}

}  // namespace fovea::oxts_test
