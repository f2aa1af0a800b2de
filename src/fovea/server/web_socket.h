// Sends the messages of a feed to one client.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fovea/server/web_context.h"

namespace fovea::web {

/// Sends the messages of a feed. Handlers under way keep it alive.
class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  WebSocket(WebContext& server, beast::tcp_stream stream, std::unique_ptr<WebFeed> feed);
  ~WebSocket();

  void run(const http::request<http::string_body>& request);

  /// Sends the next message of the feed, after the message under way. Call it when the feed may
  /// have one.
  void feed();

 private:
  void read();

  void send(const std::optional<WebMessage>& message);

  /// The handlers under way end with errors, and with the last of them the socket is gone.
  void close();

  WebContext& server_;
  websocket::stream<beast::tcp_stream> stream_;
  std::unique_ptr<WebFeed> feed_;
  beast::flat_buffer buffer_;
  std::shared_ptr<const std::string> sent_;
  bool busy_ = false, again_ = false;
};

}  // namespace fovea::web
