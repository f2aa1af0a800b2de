#include "fovea/drive/bridge/pose_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/drive/bridge/message_writer.h"
#include "fovea/drive/recordings/ros_messages.h"

namespace fovea::pose_messages_test {
namespace {

using namespace fovea::bridge;
using Json = nlohmann::json;
using testing::Each;
using testing::HasSubstr;

/// Turned by 90 degrees about the vertical: the LiDAR's x axis is the world's y axis.
PublishedPose turned_pose() {
  PublishedPose pose;
  pose.frame = 12;
  pose.stamp = 1'700'000'000'123'456'789;
  pose.T_world_lidar.translation() = Eigen::Vector3d(1.5, -2.25, 1e-3);
  pose.T_world_lidar.linear() =
      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.state = "tracked";
  return pose;
}

MessageReader reader(const std::string& message, std::string_view encoding) {
  return MessageReader(message, encoding, "a test");
}

template <class Message>
void expect_pose(const Message& message) {
  EXPECT_EQ(message.header.stamp, turned_pose().stamp);
  EXPECT_EQ(message.header.frame, "fovea_local");
  EXPECT_EQ(message.child_frame, "fovea_lidar");
  EXPECT_TRUE(message.T_header_child.matrix().isApprox(turned_pose().T_world_lidar, 1e-12));
}

TEST(PoseMessages, AreReadAsTheyWereWritten) {
  for (const std::string_view encoding : {kCdrEncoding, kRos1Encoding}) {
    SCOPED_TRACE(encoding);
    const std::vector<std::string> messages = pose_messages(turned_pose(), encoding);
    ASSERT_EQ(messages.size(), pose_channels(encoding).size());
    MessageReader odometry = reader(messages[0], encoding);
    expect_pose(ros::read_odometry(odometry));
    MessageReader tf = reader(messages[1], encoding);
    const std::vector<ros::Transform> transforms = ros::read_transforms(tf);
    ASSERT_EQ(transforms.size(), 1u);
    expect_pose(transforms[0]);
    MessageReader state = reader(messages[2], encoding);
    const Json read = Json::parse(state.text());
    EXPECT_EQ(read, Json::parse(R"({"frame": 12, "stamp_ns": 1700000000123456789,
                                     "state": "tracked"})"));
  }
}

/// The two covariances of an Odometry message, of its pose and of its twist.
struct Covariances {
  std::array<double, 36> pose, twist;
};
Covariances covariances(const PublishedPose& pose, std::string_view encoding) {
  const std::string message = pose_messages(pose, encoding)[0];
  MessageReader odometry = reader(message, encoding);
  ros::read_header(odometry);
  odometry.text();
  odometry.doubles<7>();
  Covariances read;
  read.pose = odometry.doubles<36>();
  odometry.doubles<6>();
  read.twist = odometry.doubles<36>();
  EXPECT_ANY_THROW(odometry.number<std::uint8_t>()) << "the message has no more bytes";
  return read;
}

TEST(PoseMessages, TheCovarianceIsThatOfTheWorldsAxes) {
  PublishedPose pose = turned_pose();
  pose.covariance = PoseCovariance::Zero();
  (*pose.covariance)(0, 0) = 0.09;                              // rotation about the LiDAR's x axis
  (*pose.covariance)(3, 3) = 0.04;                              // its own x axis
  (*pose.covariance)(0, 5) = (*pose.covariance)(5, 0) = 0.001;  // rotation about x, and z
  const auto at = [](std::size_t row, std::size_t column) { return 6 * row + column; };
  std::array<double, 36> expected{};
  expected[at(1, 1)] = 0.04;                        // y of the world
  expected[at(4, 4)] = 0.09;                        // rotation about y of the world
  expected[at(4, 2)] = expected[at(2, 4)] = 0.001;  // rotation about y, and z
  for (const std::string_view encoding : {kCdrEncoding, kRos1Encoding}) {
    const Covariances read = covariances(pose, encoding);
    for (std::size_t k = 0; k < 36; ++k) EXPECT_NEAR(read.pose[k], expected[k], 1e-15) << k;
    EXPECT_THAT(read.twist, Each(0));
  }
}

TEST(PoseMessages, AnUnknownCovarianceIsZero) {
  PublishedPose pose = turned_pose();
  EXPECT_THAT(covariances(pose, kCdrEncoding).pose, Each(0));
  pose.covariance = PoseCovariance::Constant(std::nan(""));
  EXPECT_THAT(covariances(pose, kCdrEncoding).pose, Each(0));
}

TEST(PoseMessages, JsonHasTheFieldsOfRos2) {
  PublishedPose pose = turned_pose();
  pose.covariance = PoseCovariance::Identity();
  const std::vector<std::string> messages = pose_messages(pose, kJsonEncoding);
  const Json header = {{"stamp", {{"sec", 1'700'000'000}, {"nanosec", 123'456'789}}},
                       {"frame_id", "fovea_local"}};
  const Json odometry = Json::parse(messages[0]);
  EXPECT_EQ(odometry.at("header"), header);
  EXPECT_EQ(odometry.at("child_frame_id"), "fovea_lidar");
  EXPECT_EQ(odometry.at("/pose/pose/position/y"_json_pointer), -2.25);
  EXPECT_NEAR(odometry.at("/pose/pose/orientation/w"_json_pointer).get<double>(), std::sqrt(0.5),
              1e-12);
  EXPECT_EQ(odometry.at("/pose/covariance"_json_pointer).size(), 36u);
  EXPECT_NEAR(odometry.at("/pose/covariance/35"_json_pointer).get<double>(), 1, 1e-12);
  EXPECT_EQ(odometry.at("/twist/covariance"_json_pointer).size(), 36u);
  EXPECT_EQ(odometry.at("/twist/twist/angular/z"_json_pointer), 0);
  const Json transform = Json::parse(messages[1]).at("transforms").at(0);
  EXPECT_EQ(transform.at("header"), header);
  EXPECT_EQ(transform.at("/transform/translation/x"_json_pointer), 1.5);
  const Json state = Json::parse(Json::parse(messages[2]).at("data").get<std::string>());
  EXPECT_EQ(state.at("state"), "tracked");
}

TEST(PoseMessages, AStampBeforeTheEpochHasPositiveNanoseconds) {
  PublishedPose pose;
  pose.stamp = -1;
  const Json stamp = Json::parse(pose_messages(pose, kJsonEncoding)[0]).at("header").at("stamp");
  EXPECT_EQ(stamp, (Json{{"sec", -1}, {"nanosec", 999'999'999}}));
}

TEST(PoseMessages, ChannelsNameTheirTypesAsTheirRosDoes) {
  for (const std::string_view encoding : {kCdrEncoding, kRos1Encoding, kJsonEncoding}) {
    const bool is_ros1 = encoding == kRos1Encoding;
    const std::vector<ClientChannel> channels = pose_channels(encoding);
    EXPECT_EQ(channels[0].topic, "/fovea/odometry");
    EXPECT_EQ(channels[0].schema_name, is_ros1 ? "nav_msgs/Odometry" : "nav_msgs/msg/Odometry");
    EXPECT_EQ(channels[1].topic, "/tf");
    EXPECT_EQ(channels[1].schema_name, is_ros1 ? "tf2_msgs/TFMessage" : "tf2_msgs/msg/TFMessage");
    EXPECT_EQ(channels[2].topic, "/fovea/state");
    EXPECT_EQ(channels[2].schema_name, is_ros1 ? "std_msgs/String" : "std_msgs/msg/String");
    for (const ClientChannel& channel : channels) {
      EXPECT_EQ(channel.encoding, encoding);
      EXPECT_EQ(channel.schema_encoding, is_ros1 ? "ros1msg" : "ros2msg");
    }
    EXPECT_THAT(channels[0].schema, HasSubstr(is_ros1 ? "uint32 seq\ntime stamp" : "int32 sec"));
  }
}

TEST(MessageWriter, AlignsNumbersInCdrOnly) {
  MessageWriter cdr(kCdrEncoding), ros1(kRos1Encoding);
  for (MessageWriter* writer : {&cdr, &ros1}) {
    writer->text("abc");
    writer->number(std::uint8_t{7});
    writer->number(1.0);
  }
  const std::string one("\0\0\0\0\0\0\xf0\x3f", 8);
  EXPECT_EQ(cdr.bytes(), std::string("\0\1\0\0\4\0\0\0abc\0\7\0\0\0\0\0\0\0", 20) + one);
  EXPECT_EQ(ros1.bytes(), std::string("\3\0\0\0abc\7", 8) + one);
}

}  // namespace
}  // namespace fovea::pose_messages_test
