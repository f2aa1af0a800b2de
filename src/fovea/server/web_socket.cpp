#include "fovea/server/web_socket.h"

#include <exception>
#include <utility>

namespace fovea::web {
namespace {

/// A WebSocket holds at most so much that its client has not taken: what comes later is newer.
constexpr int kSendBuffer = 256 * 1024;  // bytes

constexpr std::size_t kFragment = 64 * 1024;  // bytes

}  // namespace

WebSocket::WebSocket(WebContext& server, beast::tcp_stream stream, std::unique_ptr<WebFeed> feed)
    : server_(server), stream_(std::move(stream)), feed_(std::move(feed)) {
  ++server_.connections;
  server_.sockets.insert(this);
  server_.feeds_open = server_.sockets.size();
}

WebSocket::~WebSocket() {
  --server_.connections;
  server_.sockets.erase(this);
  server_.feeds_open = server_.sockets.size();
}

void WebSocket::run(const http::request<http::string_body>& request) {
  beast::get_lowest_layer(stream_).expires_never();  // the WebSocket has a clock of its own
  websocket::stream_base::timeout patience{};
  patience.handshake_timeout = server_.options.request_patience;
  patience.idle_timeout = server_.options.socket_patience;
  patience.keep_alive_pings = true;
  stream_.set_option(patience);
  stream_.read_message_max(server_.options.max_message);
  stream_.write_buffer_bytes(kFragment);  // between fragments a slow client shows signs of life
  error_code ignored;
  beast::get_lowest_layer(stream_).socket().set_option(
      asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  stream_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (error) return;
    self->read();
    self->feed();
  });
}

void WebSocket::feed() {
  if (busy_) {
    again_ = true;
    return;
  }
  busy_ = true;
  again_ = false;
  asio::post(server_.maker_io, [self = shared_from_this()]() mutable {
    std::optional<WebMessage> message;
    bool failed = false;
    try {
      message = self->feed_->next();
    } catch (const std::exception&) {
      failed = true;  // the client comes again, and begins anew
    }
    // Lets go of itself here: it ends in io_'s thread.
    WebContext& server = self->server_;
    asio::post(server.io, [self = std::move(self), message = std::move(message), failed] {
      if (failed) return self->close();
      self->send(message);
    });
  });
}

void WebSocket::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->close();
    self->buffer_.clear();  // nothing that a client says is of interest
    self->read();
  });
}

void WebSocket::send(const std::optional<WebMessage>& message) {
  if (!message) {
    busy_ = false;
    if (again_) feed();
    return;
  }
  sent_ = message->bytes;
  stream_.binary(message->binary);
  stream_.async_write(asio::buffer(*sent_),
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (error) return self->close();
                        self->sent_.reset();
                        self->busy_ = false;
                        self->feed();
                      });
}

void WebSocket::close() {
  error_code ignored;
  beast::get_lowest_layer(stream_).socket().close(ignored);
}

}  // namespace fovea::web
