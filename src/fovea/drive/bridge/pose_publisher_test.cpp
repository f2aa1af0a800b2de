#include "fovea/drive/bridge/pose_publisher.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <nlohmann/json.hpp>

#include "fovea/drive/bridge/bridge_reader.h"
#include "fovea/drive/bridge/pose_messages.h"
#include "fovea/drive/bridge/test_bridge.h"
#include "fovea/drive/recordings/message_reader.h"

namespace fovea::pose_publisher_test {
namespace {

using namespace fovea::bridge;
using namespace std::chrono_literals;
using Json = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kProtocol = "foxglove.websocket.v1";

class NoTopics : public BagSink {
 public:
  bool is_requested(const BagTopic& topic) override {
    offered.push_back(topic.name);
    return false;
  }
  void add(const BagTopic& /*topic*/, std::string_view /*message*/) override {}

  std::vector<std::string> offered;
};

BridgeFigures read(const TestBridge& server, PosePublisher& poses, NoTopics& sink,
                   const std::stop_token& stop = {}) {
  BridgeOptions options;
  options.address = server.address();
  options.poses = &poses;
  BridgeFigures figures;
  read_bridge(options, sink, stop, [](bool) {}, figures);
  return figures;
}
BridgeFigures read(const TestBridge& server, PosePublisher& poses) {
  NoTopics sink;
  return read(server, poses, sink);
}

void send_info(TestBridge::WebSocket& stream, const std::string& encodings,
               const std::string& capabilities = R"("clientPublish")") {
  TestBridge::send_text(
      stream,
      fmt::format(R"({{"op": "serverInfo", "capabilities": [{}], "supportedEncodings": [{}]}})",
                  capabilities, encodings));
}

/// The encoding of the channels that the client offers.
std::string offered_encoding(TestBridge::WebSocket& stream) {
  const Json request = Json::parse(TestBridge::receive(stream));
  EXPECT_EQ(request.at("op"), "advertise");
  EXPECT_EQ(request.at("channels").size(), 3u);
  for (std::uint32_t k = 0; k < 3; ++k) EXPECT_EQ(request.at("channels")[k].at("id"), k + 1);
  return request.at("channels")[0].at("encoding");
}

/// The frame whose pose the next three messages are, by its state.
int receive_frame(TestBridge::WebSocket& stream, std::string_view encoding) {
  std::string message;
  for (char channel = 1; channel <= 3; ++channel) {
    message = TestBridge::receive(stream);
    EXPECT_TRUE(stream.got_binary());
    EXPECT_EQ(message.substr(0, 5), (std::string{1, channel, 0, 0, 0}));
  }
  message.erase(0, 5);
  std::string state;
  if (encoding == kJsonEncoding) {
    state = Json::parse(message).at("data").get<std::string>();
  } else {
    state = MessageReader(message, encoding, "a test").text();
  }
  return Json::parse(state).at("frame");
}

PublishedPose pose_of(int frame) {
  PublishedPose pose;
  pose.frame = frame;
  pose.state = "tracked";
  return pose;
}

/// Ends a connection as a network does.
void cut(TestBridge::WebSocket& stream) {
  stream.next_layer().set_option(boost::asio::socket_base::linger(true, 0));
  stream.next_layer().close();
}

TEST(PosePublisher, PublishesInAnEncodingOfTheBridge) {
  for (const auto& [encodings, encoding] :
       {std::pair(R"("json", "ros1", "cdr")", "cdr"), std::pair(R"("json", "ros1")", "ros1"),
        std::pair(R"("protobuf", "json")", "json"), std::pair("", "json")}) {
    SCOPED_TRACE(encodings);
    std::string offered;
    std::vector<int> frames;
    const TestBridge server(kProtocol, [&](TestBridge::WebSocket& stream) {
      send_info(stream, encodings);
      offered = offered_encoding(stream);
      for (int k = 0; k < 2; ++k) frames.push_back(receive_frame(stream, offered));
      TestBridge::close(stream);
    });
    PosePublisher poses;
    poses.publish(pose_of(4));
    poses.publish(pose_of(5));
    EXPECT_THAT(read(server, poses).warnings, IsEmpty());
    EXPECT_EQ(offered, encoding);
    EXPECT_THAT(frames, ElementsAre(4, 5));
    EXPECT_EQ(poses.sent(), 2u);
  }
}

TEST(PosePublisher, AnotherThreadPublishesWhileTheBridgeIsSilent) {
  std::promise<void> is_offered;
  const TestBridge server(kProtocol, [&](TestBridge::WebSocket& stream) {
    send_info(stream, R"("cdr")");
    offered_encoding(stream);
    is_offered.set_value();
    for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(receive_frame(stream, "cdr"), frame);
    TestBridge::close(stream);
  });
  PosePublisher poses;
  const std::jthread tracker([&] {
    is_offered.get_future().wait();
    for (int frame = 0; frame < 3; ++frame) poses.publish(pose_of(frame));
  });
  EXPECT_THAT(read(server, poses).warnings, IsEmpty());
  EXPECT_EQ(poses.counts().posted, 3u);
  EXPECT_EQ(poses.counts().dropped, 0u);
}

TEST(PosePublisher, OffersItsTopicsAgainAfterAReconnection) {
  PosePublisher poses;
  int connection = 0;
  std::vector<int> frames;
  const TestBridge server(kProtocol, [&](TestBridge::WebSocket& stream) {
    send_info(stream, ++connection == 1 ? R"("cdr")" : R"("ros1")");
    const std::string encoding = offered_encoding(stream);
    EXPECT_EQ(encoding, connection == 1 ? "cdr" : "ros1");
    poses.publish(pose_of(connection));
    frames.push_back(receive_frame(stream, encoding));
    return connection < 3 ? cut(stream) : TestBridge::close(stream);
  });
  const BridgeFigures figures = read(server, poses);
  EXPECT_THAT(frames, ElementsAre(1, 2, 3));
  EXPECT_EQ(figures.losses, 2u);
}

TEST(PosePublisher, WithdrawsItsTopicsIfTheBridgeChanges) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    send_info(stream, R"("cdr")");
    EXPECT_EQ(offered_encoding(stream), "cdr");
    send_info(stream, R"("json")");
    EXPECT_EQ(Json::parse(TestBridge::receive(stream)),
              Json::parse(R"({"op": "unadvertise", "channelIds": [1, 2, 3]})"));
    EXPECT_EQ(offered_encoding(stream), "json");
    TestBridge::close(stream);
  });
  PosePublisher poses;
  read(server, poses);
}

TEST(PosePublisher, PublishesNothingToABridgeThatAcceptsNothing) {
  for (const auto& [encodings, capabilities, warning] :
       {std::tuple(R"("cdr")", R"("time")", "accepts no messages of clients"),
        std::tuple(R"("protobuf")", R"("clientPublish")", "neither as cdr, ros1 nor json")}) {
    std::string first_message;
    const TestBridge server(kProtocol, [&](TestBridge::WebSocket& stream) {
      send_info(stream, encodings, capabilities);
      // Only the subscription to this topic comes.
      TestBridge::send_text(stream, R"({"op": "advertise", "channels": [{"id": 5,
          "topic": "/imu", "encoding": "cdr", "schemaName": "sensor_msgs/Imu"}]})");
      first_message = TestBridge::receive(stream);
      TestBridge::close(stream);
    });
    class Imu : public NoTopics {
     public:
      bool is_requested(const BagTopic& /*topic*/) override { return true; }
    } sink;
    PosePublisher poses;
    for (int frame = 0; frame < 100; ++frame) poses.publish(pose_of(frame));
    EXPECT_THAT(read(server, poses, sink).warnings, ElementsAre(HasSubstr(warning)));
    EXPECT_THAT(first_message, HasSubstr("subscribe"));
    EXPECT_EQ(poses.sent(), 0u);
  }
}

// The connection stays open until the last pose is published: about 60 MB, more than sockets hold.
TEST(PosePublisher, DropsTheOldestPosesOfABridgeThatDoesNotRead) {
  std::promise<void> is_offered, ends;
  const TestBridge server(kProtocol, [&](TestBridge::WebSocket& stream) {
    send_info(stream, R"("cdr")");
    offered_encoding(stream);
    is_offered.set_value();
    ends.get_future().wait();
  });
  PosePublisher poses;
  std::stop_source stop;
  const std::jthread tracker([&] {
    is_offered.get_future().wait();
    PublishedPose pose = pose_of(0);
    pose.state = std::string(200'000, 's');
    for (; pose.frame < 300; ++pose.frame) {
      poses.publish(pose);
      std::this_thread::sleep_for(1ms);  // a bridge that reads would take it
    }
    stop.request_stop();
  });
  NoTopics sink;
  const BridgeFigures figures = read(server, poses, sink, stop.get_token());
  ends.set_value();
  EXPECT_EQ(poses.counts().posted, 300u);
  EXPECT_GT(poses.counts().dropped, 0u);
  EXPECT_THAT(figures.warnings, ElementsAre(HasSubstr("of 300 poses were not sent")));
}

TEST(PosePublisher, FoveaDoesNotReadItsOwnPoses) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    for (const char* topic : {"/fovea/odometry", "/fovea/state", "/imu"}) {
      TestBridge::send_text(stream, fmt::format(R"({{"op": "advertise", "channels": [{{"id": 1,
          "topic": "{}", "encoding": "cdr", "schemaName": "nav_msgs/Odometry"}}]}})",
                                                topic));
    }
    TestBridge::close(stream);
  });
  PosePublisher poses;
  NoTopics sink;
  read(server, poses, sink);
  EXPECT_THAT(sink.offered, ElementsAre("/imu"));
}

}  // namespace
}  // namespace fovea::pose_publisher_test
