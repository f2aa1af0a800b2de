#include "fovea/drive/bridge/connection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "fovea/drive/bridge/test_bridge.h"

namespace fovea::connection_test {
namespace {

using namespace fovea::bridge;
using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr const char* kProtocol = "foxglove.websocket.v1";

/// What a connection that cannot be made says.
std::string failure(const TestBridge& server, const ConnectionOptions& options = {}) {
  try {
    const Connection connection(server.address(), options);
  } catch (const ConnectionError& error) {
    return error.what();
  }
  return "";
}

TEST(BridgeConnection, PassesMessagesInBothDirections) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    TestBridge::send_text(stream, "a text");
    TestBridge::send_binary(stream, std::string(1'000'000, '\1'));
    TestBridge::send_text(stream, TestBridge::receive(stream));
    TestBridge::close(stream);
  });
  Connection connection(server.address());
  EXPECT_TRUE(connection.send({false, "an answer"}));
  const auto text = connection.receive({}), binary = connection.receive({});
  ASSERT_TRUE(text && binary);
  EXPECT_FALSE(text->is_binary);
  EXPECT_EQ(text->bytes, "a text");
  EXPECT_TRUE(binary->is_binary);
  EXPECT_EQ(binary->bytes, std::string(1'000'000, '\1'));
  EXPECT_EQ(connection.receive({}).value().bytes, "an answer");
  EXPECT_FALSE(connection.is_closed());
  EXPECT_FALSE(connection.receive({}));
  EXPECT_TRUE(connection.is_closed());
}

TEST(BridgeConnection, SpeaksTheNewerProtocol) {
  const TestBridge server("foxglove.sdk.v1", TestBridge::wait_for_end);
  EXPECT_EQ(failure(server), "");
}

TEST(BridgeConnection, RefusesOtherServers) {
  const TestBridge without("", TestBridge::wait_for_end);
  EXPECT_THAT(failure(without), HasSubstr("does not use a protocol of the Foxglove bridge"));
  const TestBridge other("graphql-ws", TestBridge::wait_for_end);
  EXPECT_THAT(failure(other), HasSubstr("uses another protocol, 'graphql-ws'"));
  const TestBridge web([](TestBridge::Socket socket) {
    const std::string page = "HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n";
    boost::asio::write(socket, boost::asio::buffer(page));
  });
  EXPECT_THAT(failure(web), HasSubstr("this is no Foxglove bridge"));
}

TEST(BridgeConnection, NeedsAnAnswerInTime) {
  const TestBridge closes([](TestBridge::Socket) {});
  EXPECT_THAT(failure(closes), HasSubstr("this is no Foxglove bridge"));
  std::stop_source ends;
  const TestBridge silent([&](TestBridge::Socket) {
    while (!ends.stop_requested()) std::this_thread::sleep_for(5ms);
  });
  ConnectionOptions options;
  options.timeout = 100ms;
  EXPECT_THAT(failure(silent, options), HasSubstr("this is no Foxglove bridge"));
  ends.request_stop();
}

TEST(BridgeConnection, NothingListens) {
  Address address;
  {
    const TestBridge server([](TestBridge::Socket) {});
    address = server.address();
  }
  try {
    const Connection connection(address);
    FAIL();
  } catch (const ConnectionError& error) {
    EXPECT_EQ(error.problem().rfind("no bridge can be reached", 0), 0u) << error.what();
    EXPECT_EQ(error.where(), address.text());
  }
}

TEST(BridgeConnection, WaitsNoLongerThanItShall) {
  const TestBridge server(kProtocol, TestBridge::wait_for_end);
  Connection connection(server.address());
  EXPECT_FALSE(connection.receive({}, 10ms));
  EXPECT_FALSE(connection.is_closed());
  std::stop_source stop;
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(20ms);  // while the connection waits
    stop.request_stop();
  });
  EXPECT_FALSE(connection.receive(stop.get_token(), 1h));
}

TEST(BridgeConnection, ALostOneIsAnError) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    TestBridge::send_text(stream, "last");
    stream.next_layer().set_option(boost::asio::socket_base::linger(true, 0));  // resets it
    TestBridge::receive(stream);
    stream.next_layer().close();
  });
  Connection connection(server.address());
  EXPECT_EQ(connection.receive({}).value().bytes, "last");
  EXPECT_TRUE(connection.send({false, "end"}));
  EXPECT_THROW(connection.receive({}), ConnectionError);
  EXPECT_FALSE(connection.is_closed());
}

TEST(BridgeConnection, OneThatEndsWithoutACloseIsLost) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    stream.next_layer().shutdown(TestBridge::Socket::shutdown_both);
  });
  Connection connection(server.address());
  EXPECT_THROW(connection.receive({}), ConnectionError);
  EXPECT_FALSE(connection.is_closed());
}

TEST(BridgeConnection, AMessageTooLongIsAnError) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    TestBridge::send_binary(stream, std::string(2 << 20, ' '));
    TestBridge::wait_for_end(stream);
  });
  ConnectionOptions options;
  options.max_message = 1 << 20;
  Connection connection(server.address(), options);
  try {
    connection.receive({});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a message has more than 1 MiB"));
  }
}

TEST(BridgeConnection, DropsWhatTheBridgeDoesNotTake) {
  const TestBridge server(kProtocol, TestBridge::wait_for_end);
  ConnectionOptions options;
  options.max_unsent = 100;
  Connection connection(server.address(), options);
  EXPECT_TRUE(connection.send({true, std::string(60, 'x')}));
  EXPECT_FALSE(connection.send({true, std::string(60, 'x')}));
  bool is_sent = false;
  for (int i = 0; i < 1000 && !is_sent; ++i) {
    EXPECT_FALSE(connection.receive({}, 10ms));  // sends the first one
    is_sent = connection.send({true, std::string(60, 'x')});
  }
  EXPECT_TRUE(is_sent);
}

TEST(BridgeConnection, SendsForOtherThreadsWhileItWaits) {
  const TestBridge server(kProtocol, [](TestBridge::WebSocket& stream) {
    for (const char* expected : {"1", "2", "3"}) EXPECT_EQ(TestBridge::receive(stream), expected);
    TestBridge::close(stream);
  });
  std::atomic<int> offered = 0;
  int sent = 0;
  Connection connection(server.address());
  connection.send_from([&]() -> std::optional<WireMessage> {
    if (sent == offered) return std::nullopt;
    return WireMessage{true, std::to_string(++sent)};
  });
  const std::jthread publisher([&] {
    std::this_thread::sleep_for(20ms);  // while the connection waits
    offered = 3;
    connection.wake();
  });
  EXPECT_FALSE(connection.receive({}, 1h));
  EXPECT_TRUE(connection.is_closed());
}

}  // namespace
}  // namespace fovea::connection_test
