// What a web server shares with its connections. Only this header and the files that include it use
// Boost.
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstddef>
#include <map>
#include <set>
#include <string>

#include "fovea/server/web_server.h"

namespace fovea::web {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;

class WebSocket;

/// Only the thread of `io` uses the members that are neither constant nor atomic.
struct WebContext {
  WebContext(const WebServerOptions& options_, WebServer::Handler handler_,
             std::map<std::string, WebServer::FeedMaker> feeds_)
      : options(options_), handler(std::move(handler_)), feeds(std::move(feeds_)) {}

  const WebServerOptions options;
  const WebServer::Handler handler;
  const std::map<std::string, WebServer::FeedMaker> feeds;
  std::size_t connections = 0;
  std::set<WebSocket*> sockets;
  std::atomic<std::size_t> feeds_open{0};  ///< sockets.size(), for other threads
  std::atomic<std::size_t> pending{0};     ///< requests that wait for a response
  /// Its destructor destroys the connections, which use the members above.
  asio::io_context io{1};
  asio::io_context maker_io;  ///< for responses that take time, in threads of their own
};

}  // namespace fovea::web
