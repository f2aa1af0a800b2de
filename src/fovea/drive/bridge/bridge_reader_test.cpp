#include "fovea/drive/bridge/bridge_reader.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "fovea/drive/bridge/test_bridge.h"

namespace fovea::bridge_reader_test {
namespace {

using namespace fovea::bridge;
using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kProtocol = "foxglove.websocket.v1";

/// Requests all topics but "/other".
class Sink : public BagSink {
 public:
  bool is_requested(const BagTopic& topic) override {
    types.push_back(topic.type);
    return topic.name != "/other";
  }
  void add(const BagTopic& topic, std::string_view message) override {
    messages.push_back(fmt::format("{} {}", topic.name, message));
  }

  std::vector<std::string> types, messages;
};

void advertise(TestBridge::WebSocket& stream, const std::string& topic, int id,
               const std::string& encoding = "cdr") {
  TestBridge::send_text(stream,
                        fmt::format(R"({{"op": "advertise", "channels": [{{"id": {}, "topic": "{}",
                  "encoding": "{}", "schemaName": "sensor_msgs/Imu"}}]}})",
                                    id, topic, encoding));
}

/// The subscription of a channel that was just advertised.
std::uint32_t subscription(TestBridge::WebSocket& stream, int channel) {
  const auto request = nlohmann::json::parse(TestBridge::receive(stream));
  EXPECT_EQ(request.at("op"), "subscribe");
  EXPECT_EQ(request.at("subscriptions").size(), 1u);
  EXPECT_EQ(request.at("subscriptions")[0].at("channelId"), channel);
  return request.at("subscriptions")[0].at("id");
}

void send_data(TestBridge::WebSocket& stream, std::uint32_t subscription,
               const std::string& payload) {
  std::string bytes(13, '\0');
  bytes[0] = 1;
  for (std::size_t k = 0; k < 4; ++k) bytes[1 + k] = char(subscription >> (8 * k) & 0xff);
  TestBridge::send_binary(stream, bytes + payload);
}

BridgeFigures read(const TestBridge& server, Sink& sink,
                   std::chrono::milliseconds reconnect = 20s) {
  BridgeOptions options;
  options.address = server.address();
  options.reconnect = reconnect;
  BridgeFigures figures;
  read_bridge(options, sink, {}, [](bool) {}, figures);
  return figures;
}

TEST(BridgeReader, PassesTheRequestedTopicsOn) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    advertise(stream, "/other", 3);
    advertise(stream, "/json", 4, "json");
    advertise(stream, "/imu", 5);
    const std::uint32_t imu = subscription(stream, 5);
    send_data(stream, imu, "one");
    send_data(stream, imu + 1, "of no subscription");
    send_data(stream, imu, "two");
    TestBridge::close(stream);
  });
  Sink sink;
  const BridgeFigures figures = read(server, sink);
  EXPECT_THAT(sink.messages, ElementsAre("/imu one", "/imu two"));
  EXPECT_EQ(sink.types.front(), "sensor_msgs/msg/Imu");
  EXPECT_EQ(figures.messages, 2u);
  EXPECT_EQ(figures.losses, 0u);
  EXPECT_THAT(figures.warnings, IsEmpty());
}

TEST(BridgeReader, ChannelsMayComeBackWithOtherIds) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    advertise(stream, "/imu", 5);
    const std::uint32_t first = subscription(stream, 5);
    send_data(stream, first, "one");
    TestBridge::send_text(stream, R"({"op": "unadvertise", "channelIds": [5]})");
    send_data(stream, first, "of a channel that has gone");
    advertise(stream, "/imu", 9);
    send_data(stream, subscription(stream, 9), "two");
    TestBridge::close(stream);
  });
  Sink sink;
  read(server, sink);
  EXPECT_THAT(sink.messages, ElementsAre("/imu one", "/imu two"));
}

TEST(BridgeReader, OneOfTwoChannelsOfATopicIsReadAtATime) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    advertise(stream, "/imu", 5);
    const std::uint32_t first = subscription(stream, 5);
    advertise(stream, "/imu", 6);
    send_data(stream, first, "one");
    TestBridge::send_text(stream, R"({"op": "unadvertise", "channelIds": [5]})");
    send_data(stream, subscription(stream, 6), "two");
    TestBridge::close(stream);
  });
  Sink sink;
  const BridgeFigures figures = read(server, sink);
  EXPECT_THAT(sink.messages, ElementsAre("/imu one", "/imu two"));
  EXPECT_THAT(figures.warnings, ElementsAre(HasSubstr("two channels have the topic /imu")));
}

TEST(BridgeReader, DamagedMessagesAreCounted) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    TestBridge::send_text(stream, "{");
    TestBridge::send_binary(stream, "\1");
    TestBridge::send_text(stream, R"({"op": "status", "level": 2, "message": "no\u0007 disk"})");
    TestBridge::close(stream);
  });
  Sink sink;
  const BridgeFigures figures = read(server, sink);
  EXPECT_EQ(figures.damaged, 2u);
  ASSERT_EQ(figures.warnings.size(), 2u);
  EXPECT_THAT(figures.warnings[0], HasSubstr("the bridge reports: no"));
  EXPECT_EQ(figures.warnings[0].find('\a'), std::string::npos);
  EXPECT_THAT(figures.warnings[1], HasSubstr("2 messages of the bridge cannot be read"));
}

/// Ends a connection without a word, as a network does.
void cut(TestBridge::WebSocket& stream) {
  stream.next_layer().set_option(boost::asio::socket_base::linger(true, 0));
  stream.next_layer().close();
}

/// Sends a message, and waits until it has come.
void send_and_wait(TestBridge::WebSocket& stream, std::uint32_t subscription,
                   const std::string& payload, const std::atomic<int>& received, int count) {
  send_data(stream, subscription, payload);
  while (received < count) std::this_thread::sleep_for(1ms);
}

class CountingSink : public Sink {
 public:
  void add(const BagTopic& topic, std::string_view message) override {
    Sink::add(topic, message);
    ++received;
  }
  std::atomic<int> received = 0;
};

TEST(BridgeReader, ALostConnectionIsMadeAgain) {
  CountingSink sink;
  int number = 0;
  const TestBridge server(kProtocol, [&](TestBridge::WebSocket& stream) {
    ++number;
    advertise(stream, "/imu", 5 + number);
    const std::uint32_t imu = subscription(stream, 5 + number);
    send_and_wait(stream, imu, std::to_string(number), sink.received, number);
    return number < 3 ? cut(stream) : TestBridge::close(stream);
  });
  const BridgeFigures figures = read(server, sink);
  EXPECT_THAT(sink.messages, ElementsAre("/imu 1", "/imu 2", "/imu 3"));
  EXPECT_EQ(figures.losses, 2u);
  EXPECT_THAT(figures.warnings, ElementsAre(HasSubstr("the connection was lost 2 times")));
  EXPECT_FALSE(figures.ended_lost);
}

// A bridge that takes connections and drops them must not keep the client for ever.
TEST(BridgeReader, GivesUpAConnectionThatStaysLost) {
  CountingSink sink;
  std::atomic<int> connections = 0;
  const TestBridge server(kProtocol, [&](TestBridge::WebSocket& stream) {
    if (++connections > 1) return cut(stream);
    advertise(stream, "/imu", 5);
    send_and_wait(stream, subscription(stream, 5), "one", sink.received, 1);
    cut(stream);
  });
  const BridgeFigures figures = read(server, sink, /*reconnect=*/600ms);
  EXPECT_THAT(sink.messages, ElementsAre("/imu one"));
  EXPECT_GT(connections, 1);
  EXPECT_TRUE(figures.ended_lost);
  EXPECT_THAT(figures.warnings, testing::Contains(HasSubstr("could not be made again")));
}

TEST(BridgeReader, AMessageTooLongEndsTheReading) {
  const TestBridge server(kProtocol, [&](TestBridge::WebSocket& stream) {
    TestBridge::send_text(stream, "{");
    advertise(stream, "/imu", 5);
    send_data(stream, subscription(stream, 5), "one");
    TestBridge::send_binary(stream, std::string(2 << 20, ' '));
    TestBridge::wait_for_end(stream);
  });
  BridgeOptions options;
  options.address = server.address();
  options.connection.max_message = 1 << 20;
  Sink sink;
  BridgeFigures figures;
  EXPECT_THROW(read_bridge(options, sink, {}, [](bool) {}, figures), InputError);
  EXPECT_EQ(figures.messages, 1u);
  EXPECT_THAT(figures.warnings, ElementsAre(HasSubstr("1 messages of the bridge cannot be read")));
}

TEST(BridgeReader, AStopEndsTheWait) {
  const TestBridge server(kProtocol, TestBridge::wait_for_end);
  BridgeOptions options;
  options.address = server.address();
  std::stop_source stop;
  Sink sink;
  BridgeFigures figures;
  read_bridge(options, sink, stop.get_token(), [&](bool) { stop.request_stop(); }, figures);
  EXPECT_EQ(figures.losses, 0u);
  EXPECT_FALSE(figures.ended_lost);
}

}  // namespace
}  // namespace fovea::bridge_reader_test
