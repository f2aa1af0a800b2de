// A web server for one page: HTTP requests that are answered at once, and WebSockets that are fed.
// It serves a map to its owner's browser, so it trusts nobody: see WebServerOptions.
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
  int threads = 1;                    ///< that make responses, beside the one that moves bytes
  /// Threads of the server give way to all others of the machine.
  bool in_background = false;

  std::size_t max_connections = 128;  ///< those beyond are closed at once
  std::size_t max_pending = 112;      ///< requests waiting for a response; those beyond get 503
  std::size_t max_header = 8192;      ///< bytes
  std::size_t max_message = 4096;     ///< bytes of a WebSocket's message from the client
  std::chrono::milliseconds request_patience{
      15'000};  ///< for a request to come, idle time included
  std::chrono::milliseconds response_patience{60'000};  ///< for a response to be taken
  /// Without a sign of life for so long a WebSocket is closed; it is asked for one after half.
  std::chrono::milliseconds socket_patience{30'000};
};

struct WebResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;
};
/// One line of text that says why not.
WebResponse refusal(int status, const std::string& why);

struct WebMessage {
  std::shared_ptr<const std::string> bytes;
  bool binary = false;
};

/// What one client of a WebSocket is sent. It is asked for a message when the client has taken the
/// one before, so a client that takes nothing costs nothing.
class WebFeed {
 public:
  virtual ~WebFeed() = default;
  /// The next message; nothing: none now, ask again after WebServer::wake(). Never called twice at
  /// a time, in any of the server's threads.
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
  /// To be called once, from any thread; to be gone before the server goes.
  using Reply = std::function<void(WebResponse)>;
  /// Answers a path (decoded, without the first slash and without a query), now or later; called in
  /// several threads. What it throws, without having replied, is told as status 500.
  using Handler = std::function<void(const std::string& path, Reply reply)>;
  using FeedMaker = std::function<std::unique_ptr<WebFeed>()>;

  /// @param feeds  by the path of their WebSocket
  /// OutputError if the address is none or the port is taken.
  WebServer(const WebServerOptions& options, Handler handler,
            std::map<std::string, FeedMaker> feeds = {});
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  /// Where a browser finds it.
  std::string url() const;
  /// WebSockets that are open.
  std::size_t feeds_open() const;
  /// Asks feeds that had nothing again. From any thread; returns at once.
  void wake();
  /// Ends its threads and answers nothing any more. Who keeps replies for later drops them between
  /// this and the destruction.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea
