#include "fovea/drive/bridge/bridge_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fovea::bridge_messages_test {
namespace {

using namespace fovea::bridge;
using testing::ElementsAre;
using Json = nlohmann::json;

template <class T>
T parsed(std::string_view text) {
  return std::get<T>(parse_text(text));
}

TEST(BridgeMessages, TheServerTellsWhatItAccepts) {
  const auto info = parsed<ServerInfo>(
      R"({"op": "serverInfo", "name": "robot", "capabilities": ["time", "clientPublish"],
          "supportedEncodings": ["json", "cdr"], "metadata": {"ROS_DISTRO": "humble"},
          "sessionId": "1675789422160"})");
  EXPECT_TRUE(info.accepts_messages);
  EXPECT_THAT(info.encodings, ElementsAre("json", "cdr"));
  EXPECT_FALSE(parsed<ServerInfo>(R"({"op": "serverInfo", "capabilities": []})").accepts_messages);
  EXPECT_FALSE(parsed<ServerInfo>(R"({"op": "serverInfo"})").accepts_messages);
}

TEST(BridgeMessages, ChannelsComeAndGo) {
  const auto advertised = parsed<Advertised>(
      R"({"op": "advertise", "channels": [{"id": 4294967295, "topic": "/points", "encoding": "cdr",
          "schemaName": "sensor_msgs/msg/PointCloud2", "schema": "std_msgs/Header header"}]})");
  ASSERT_EQ(advertised.channels.size(), 1u);
  EXPECT_EQ(advertised.channels[0].id, 4294967295u);
  EXPECT_EQ(advertised.channels[0].topic, "/points");
  EXPECT_EQ(advertised.channels[0].encoding, "cdr");
  EXPECT_EQ(advertised.channels[0].type, "sensor_msgs/msg/PointCloud2");
  const auto gone = parsed<Unadvertised>(R"({"op": "unadvertise", "channelIds": [1, 2]})");
  EXPECT_THAT(gone.channel_ids, ElementsAre(1, 2));
}

TEST(BridgeMessages, AStatusHasALevel) {
  const auto status = parsed<Status>(R"({"op": "status", "level": 1, "message": "slow client"})");
  EXPECT_EQ(status.level, Status::Level::kWarning);
  EXPECT_EQ(status.text, "slow client");
}

TEST(BridgeMessages, DataHasItsSubscriptionAndTime) {
  const std::string bytes("\x01\x02\x00\x00\x80\x08\x07\x06\x05\x04\x03\x02\x01hello", 18);
  const auto data = std::get<MessageData>(parse_binary(bytes));
  EXPECT_EQ(data.subscription, 0x80000002u);
  EXPECT_EQ(data.sent, 0x0102030405060708);
  EXPECT_EQ(data.payload, "hello");
}

TEST(BridgeMessages, WhatFoveaDoesNotUseIsNoError) {
  EXPECT_TRUE(std::holds_alternative<Unused>(parse_binary("\x02time")));
  EXPECT_TRUE(
      std::holds_alternative<Unused>(parse_text(R"({"op": "parameterValues", "parameters": []})")));
}

TEST(BridgeMessages, DamagedOnesAreErrors) {
  for (const char* text :
       {"", "{", "[]", "3", R"({"op": 3})", R"({"op": "advertise"})", R"({"op": "status"})",
        R"({"op": "advertise", "channels": [{"id": -1, "topic": "t", "encoding": "cdr"}]})",
        R"({"op": "advertise", "channels": [{"id": 1.5, "topic": "t", "encoding": "cdr"}]})",
        R"({"op": "advertise", "channels": [{"id": 4294967296, "topic": "t", "encoding": "cdr"}]})",
        R"({"op": "advertise", "channels": [{"id": 1, "topic": 2, "encoding": "cdr"}]})",
        R"({"op": "advertise", "channels": 7})", R"({"op": "unadvertise", "channelIds": ["1"]})",
        R"({"op": "serverInfo", "capabilities": "clientPublish"})",
        R"({"op": "serverInfo", "supportedEncodings": [1]})", "\xff\xfe"}) {
    EXPECT_THROW(parse_text(text), DamagedMessage) << text;
  }
  EXPECT_THROW(parse_text(std::string(100'000, '[')), DamagedMessage);
  EXPECT_THROW(parse_binary(""), DamagedMessage);
  EXPECT_THROW(parse_binary(std::string_view("\x01\x02\x00\x00\x00\x00", 6)), DamagedMessage);
}

TEST(BridgeMessages, ASubscriptionIsAsTheProtocolSays) {
  const std::vector<Subscription> subscriptions{{0, 3}, {1, 5}};
  EXPECT_EQ(Json::parse(subscribe_message(subscriptions)), Json::parse(R"({"op": "subscribe",
      "subscriptions": [{"id": 0, "channelId": 3}, {"id": 1, "channelId": 5}]})"));
}

TEST(BridgeMessages, PublishedTopicsAreAsTheProtocolSays) {
  const std::vector<ClientChannel> channels{
      {7, "/pose", "cdr", "nav_msgs/msg/Odometry", "string child_frame_id", "ros2msg"}};
  EXPECT_EQ(Json::parse(advertise_message(channels)), Json::parse(R"({"op": "advertise",
      "channels": [{"id": 7, "topic": "/pose", "encoding": "cdr",
                    "schemaName": "nav_msgs/msg/Odometry", "schema": "string child_frame_id",
                    "schemaEncoding": "ros2msg"}]})"));
  EXPECT_EQ(Json::parse(unadvertise_message(channels)),
            Json::parse(R"({"op": "unadvertise", "channelIds": [7]})"));
  EXPECT_EQ(client_message_data(0x80000002, "hello"), std::string("\x01\x02\x00\x00\x80hello", 10));
}

}  // namespace
}  // namespace fovea::bridge_messages_test
