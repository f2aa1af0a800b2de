// A web server for one page: HTTP requests and WebSockets that send messages.
// It serves a private map, so it refuses everything that the page does not need: see WebServer.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace fovea {

struct WebServerOptions {
  std::string address = "127.0.0.1";  ///< of an interface of this machine
  int port = 0;                       ///< 0: any that is free
  int threads = 1;                    ///< that make responses; one more transfers bytes
  /// The threads of the server have low priority.
  bool in_background = false;

  std::size_t max_connections = 128;  ///< further ones are closed at once
  std::size_t max_pending = 112;      ///< requests without a response; further ones get 503
  std::size_t max_header = 8192;      ///< bytes
  std::size_t max_message = 4096;     ///< bytes of a WebSocket's message from the client
  std::chrono::milliseconds request_patience{
      15'000};  ///< for a request to arrive, idle time included
  std::chrono::milliseconds response_patience{60'000};  ///< for the client to receive a response
  /// A silent WebSocket is closed after this time, and gets a ping after half of it.
  std::chrono::milliseconds socket_patience{30'000};
};

struct WebResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;
};
/// A response with one line of text: the reason.
WebResponse refusal(int status, const std::string& why);

struct WebMessage {
  std::shared_ptr<const std::string> bytes;
  bool binary = false;
};

/// The messages for one client of a WebSocket. The server requests a message when the client has
/// received the one before, so a stalled client costs nothing.
class WebFeed {
 public:
  virtual ~WebFeed() = default;
  /// The next message. Empty: none now; the server calls again after WebServer::wake(). One thread
  /// at a time calls this.
  virtual std::optional<WebMessage> next() = 0;
};

/// Serves from construction to destruction.
///
/// Refused: methods other than GET and HEAD and requests with a body; a Host that is no address of
/// this machine's and no localhost (another site's name that leads here, DNS rebinding), an Origin
/// other than the Host; paths with "..", empty parts or characters that no name of ours has; too
/// long headers; requests and connections beyond the limits above.
class WebServer {
 public:
  /// Call it once, from any thread. Destroy it before the server.
  using Reply = std::function<void(WebResponse)>;
  /// Answers a path (decoded, without the first slash and without a query), now or later. Several
  /// threads call it. An exception becomes status 500.
  using Handler = std::function<void(const std::string& path, Reply reply)>;
  using FeedMaker = std::function<std::unique_ptr<WebFeed>()>;

  /// @param feeds  by the path of their WebSocket
  /// @throws OutputError  if the address is invalid or the port is in use
  WebServer(const WebServerOptions& options, Handler handler,
            std::map<std::string, FeedMaker> feeds = {});
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  /// The address for a browser.
  std::string url() const;
  /// Number of open WebSockets.
  std::size_t feeds_open() const;
  /// Requests a message from each idle feed. From any thread; returns at once.
  void wake();
  /// Ends the threads. Destroy kept replies after this and before the server.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea
