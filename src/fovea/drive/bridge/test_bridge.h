// A bridge for tests, which may misbehave.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <string>
#include <thread>

#include "fovea/drive/bridge/bridge_address.h"

namespace fovea::bridge {

/// Accepts one connection after the other, in a thread of its own.
class TestBridge {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using WebSocket = boost::beast::websocket::stream<Socket>;

  /// @param serve  called with each connection; may throw when its client has gone
  explicit TestBridge(std::function<void(Socket)> serve)
      : serve_(std::move(serve)), thread_([this] { run(); }) {}
  /// Shakes hands first.
  TestBridge(std::string protocol, std::function<void(WebSocket&)> serve)
      : TestBridge([protocol = std::move(protocol), serve = std::move(serve)](Socket socket) {
          WebSocket stream(std::move(socket));
          accept(stream, protocol);
          serve(stream);
        }) {}
  ~TestBridge() {
    ends_ = true;
    boost::system::error_code ignored;
    Socket wake(io_);
    wake.connect(acceptor_.local_endpoint(), ignored);
    thread_.join();
  }

  Address address() const {
    return {"127.0.0.1", std::to_string(acceptor_.local_endpoint().port()), "/"};
  }

  static void send_text(WebSocket& stream, const std::string& text) {
    stream.binary(false);
    stream.write(boost::asio::buffer(text));
  }
  static void send_binary(WebSocket& stream, const std::string& bytes) {
    stream.binary(true);
    stream.write(boost::asio::buffer(bytes));
  }
  static std::string receive(WebSocket& stream) {
    boost::beast::flat_buffer buffer;
    stream.read(buffer);
    return boost::beast::buffers_to_string(buffer.data());
  }
  /// Until the client has gone.
  static void wait_for_end(WebSocket& stream) {
    boost::system::error_code error;
    boost::beast::flat_buffer buffer;
    while (!error) {
      stream.read(buffer, error);
      buffer.clear();
    }
  }
  static void close(WebSocket& stream) {
    stream.close(boost::beast::websocket::close_code::normal);
  }

 private:
  static void accept(WebSocket& stream, const std::string& protocol) {
    namespace websocket = boost::beast::websocket;
    stream.set_option(websocket::stream_base::decorator([&](websocket::response_type& response) {
      if (protocol.empty()) return;
      response.set(boost::beast::http::field::sec_websocket_protocol, protocol);
    }));
    stream.accept();
  }

  void run() {
    while (true) {
      Socket socket(io_);
      acceptor_.accept(socket);
      if (ends_) return;
      try {
        serve_(std::move(socket));
      } catch (const boost::system::system_error&) {
      }
    }
  }

  boost::asio::io_context io_{1};
  boost::asio::ip::tcp::acceptor acceptor_{io_,
                                           {boost::asio::ip::address_v4::loopback(), /*port=*/0}};
  std::function<void(Socket)> serve_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace fovea::bridge
