#include "fovea/drive/bridge/connection.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <functional>

#include "fovea/drive/bridge/bridge_messages.h"

namespace fovea::bridge {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using Clock = std::chrono::steady_clock;

constexpr const char* kCheckAddress = "check the address, and that the bridge runs";

/// Names of all protocols for the header of the handshake.
std::string protocols() {
  std::string names;
  for (const std::string_view name : kProtocols) {
    if (!names.empty()) names += ", ";
    names += name;
  }
  return names;
}

/// Whether the bridge has closed the connection. If it crashes, the connection ends without this.
bool is_end(const error_code& error) { return error == websocket::error::closed; }

}  // namespace

class Connection::Socket {
 public:
  Socket(const Address& address, const ConnectionOptions& options, const std::stop_token& stop)
      : address_(address), options_(options), stream_(io_) {
    connect(stop);
    shake_hands(stop);
    read();
  }
  std::optional<WireMessage> receive(const std::stop_token& stop,
                                     std::optional<std::chrono::milliseconds> wait) {
    const auto until = wait ? Clock::now() + *wait : Clock::time_point::max();
    run_until([&] { return received_ || error_; }, stop, until);
    if (received_) {
      std::optional<WireMessage> message = std::exchange(received_, std::nullopt);
      if (!error_) read();
      return message;
    }
    if (!error_ || is_end(error_)) return std::nullopt;
    if (error_ == websocket::error::message_too_big) {
      throw InputError(fmt::format("a message has more than {} MiB", options_.max_message >> 20),
                       address_.text(), "have the robot send smaller scans and images");
    }
    throw ConnectionError(fmt::format("the connection is lost ({})", error_.message()),
                          address_.text(), "check the network and the bridge");
  }

  bool is_closed() const { return bool(error_) && is_end(error_); }

  bool send(WireMessage message) {
    if (unsent_bytes_ + message.bytes.size() > options_.max_unsent) return false;
    unsent_bytes_ += message.bytes.size();
    unsent_.push_back(std::move(message));
    if (unsent_.size() == 1) write();
    return true;
  }

  void send_from(Source source) {
    source_ = std::move(source);
    write_from_source();
  }

  void wake() {
    asio::post(io_, [this] { write_from_source(); });
  }

 private:
  /// Runs handlers until `done`, a stop or a time.
  void run_until(const std::function<bool()>& done, const std::stop_token& stop,
                 Clock::time_point until) {
    const std::stop_callback wake(stop, [this] { asio::post(io_, [] {}); });
    while (!done() && !stop.stop_requested() && Clock::now() < until) {
      io_.restart();
      // In steps: run_one_until() overflows at time_point::max().
      io_.run_one_until(std::min(until, Clock::now() + std::chrono::hours(1)));
    }
  }

  /// Runs an operation that sets `result`. ConnectionError if it fails or takes too long.
  void wait_for(std::optional<error_code>& result, const char* what, const std::stop_token& stop) {
    run_until([&] { return result.has_value(); }, stop, deadline_);
    if (result && !*result) return;
    if (stop.stop_requested()) {
      throw ConnectionError("interrupted before there was a connection", address_.text(),
                            "give the same command again");
    }
    const std::string reason = result ? result->message() : "no reply";
    throw ConnectionError(fmt::format("{} ({})", what, reason), address_.text(), kCheckAddress);
  }

  void connect(const std::stop_token& stop) {
    std::optional<error_code> result;
    tcp::resolver::results_type hosts;
    resolver_.async_resolve(address_.host, address_.port,
                            [&](error_code error, tcp::resolver::results_type found) {
                              hosts = std::move(found);
                              result = error;
                            });
    wait_for(result, "the host of the bridge is not found", stop);
    result.reset();
    asio::async_connect(beast::get_lowest_layer(stream_).socket(), hosts,
                        [&](error_code error, const tcp::endpoint&) { result = error; });
    wait_for(result, "no bridge can be reached", stop);
    error_code ignored;  // messages leave at once, not when earlier ones are acknowledged
    beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
  }

  void shake_hands(const std::stop_token& stop) {
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = options_.timeout;
    timeout.idle_timeout = options_.timeout;
    timeout.keep_alive_pings = true;
    stream_.set_option(timeout);
    stream_.read_message_max(options_.max_message);
    stream_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(beast::http::field::sec_websocket_protocol, protocols());
      request.set(beast::http::field::user_agent, "fovea");
    }));
    std::optional<error_code> result;
    websocket::response_type response;
    stream_.async_handshake(response, address_.text(), address_.path,
                            [&](error_code error) { result = error; });
    wait_for(result, "this is no Foxglove bridge", stop);
    const auto chosen = response[beast::http::field::sec_websocket_protocol];
    const std::string_view protocol(chosen.data(), chosen.size());
    if (std::find(kProtocols.begin(), kProtocols.end(), protocol) != kProtocols.end()) return;
    throw ConnectionError(protocol.empty()
                              ? "the server does not use a protocol of the Foxglove bridge"
                              : fmt::format("the server uses another protocol, '{:.40}'", protocol),
                          address_.text(), "start foxglove_bridge, and give its port");
  }

  void read() {
    stream_.async_read(buffer_, [this](error_code error, std::size_t) {
      if (error) {
        error_ = error;
        return;
      }
      received_ = WireMessage{stream_.got_binary(), beast::buffers_to_string(buffer_.data())};
      buffer_.clear();
    });
  }

  void write() {
    stream_.binary(unsent_.front().is_binary);
    stream_.async_write(asio::buffer(unsent_.front().bytes), [this](error_code error, std::size_t) {
      unsent_bytes_ -= unsent_.front().bytes.size();
      unsent_.pop_front();
      if (error && !error_) error_ = error;
      if (error_) return;
      if (unsent_.empty()) {
        write_from_source();
      } else {
        write();
      }
    });
  }

  void write_from_source() {
    if (error_ || !unsent_.empty() || !source_) return;
    if (std::optional<WireMessage> message = source_()) send(std::move(*message));
  }

  Address address_;
  ConnectionOptions options_;
  Clock::time_point deadline_ = Clock::now() + options_.timeout;  // of the connection
  asio::io_context io_{1};  // is destroyed after those below, with the handlers that have not run
  tcp::resolver resolver_{io_};
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  std::optional<WireMessage> received_;
  error_code error_;
  std::deque<WireMessage> unsent_;
  std::size_t unsent_bytes_ = 0;
  Source source_;
};

Connection::Connection(const Address& address, const ConnectionOptions& options,
                       const std::stop_token& stop)
    : socket_(std::make_unique<Socket>(address, options, stop)) {}
Connection::~Connection() = default;

std::optional<WireMessage> Connection::receive(const std::stop_token& stop,
                                               std::optional<std::chrono::milliseconds> wait) {
  return socket_->receive(stop, wait);
}

bool Connection::is_closed() const { return socket_->is_closed(); }

bool Connection::send(WireMessage message) { return socket_->send(std::move(message)); }

void Connection::send_from(Source source) { socket_->send_from(std::move(source)); }

void Connection::wake() { socket_->wake(); }

}  // namespace fovea::bridge
