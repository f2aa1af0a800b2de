// The one file that knows Boost.
#include "fovea/server/web_server.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <exception>
#include <set>
#include <thread>
#include <utility>

#include "fovea/core/errors.h"
#include "fovea/core/thread.h"
#include "fovea/core/version.h"
#include "fovea/server/web_request.h"

namespace fovea {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;

/// The page needs nothing from elsewhere, and nothing elsewhere needs what is here.
constexpr const char* kContentPolicy =
    "default-src 'self'; connect-src 'self' ws://{}; img-src 'self' blob: data:; style-src 'self' "
    "'unsafe-inline'; "
    "worker-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// A WebSocket holds at most so much that its client has not taken: what comes later is newer.
constexpr int kSendBuffer = 256 * 1024;  // bytes

constexpr std::size_t kFragment = 64 * 1024;  // bytes

/// Programs that are started, a browser say, do not keep the port.
void keep_to_this_program(int socket) { static_cast<void>(fcntl(socket, F_SETFD, FD_CLOEXEC)); }

}  // namespace

WebResponse refusal(int status, const std::string& why) {
  return {status, "text/plain; charset=utf-8", std::make_shared<const std::string>(why + "\n")};
}

class WebServer::Impl {
 public:
  Impl(const WebServerOptions& options, Handler handler, std::map<std::string, FeedMaker> feeds)
      : options_(options),
        handler_(std::move(handler)),
        feeds_(std::move(feeds)),
        acceptor_(io_),
        pause_(io_) {
    listen();
    accept();
    const ThreadPriority priority =
        options_.in_background ? ThreadPriority::kBackground : ThreadPriority::kNormal;
    const auto serve = [this](const std::stop_token&) { run(io_); };
    const auto make_replies = [this](const std::stop_token&) { run(maker_io_); };
    io_thread_ = start_thread("fovea-serve", serve, priority);
    for (int i = 0; i < options_.threads; ++i) {
      makers_.push_back(start_thread("fovea-reply", make_replies, priority));
    }
  }

  ~Impl() { stop(); }

  void stop() {
    if (!io_thread_.joinable()) return;
    io_.stop();
    io_thread_.join();
    maker_io_.stop();
    makers_.clear();  // joins; io_ ignores what they still post
  }

  class Http;
  class Socket;

  const tcp::endpoint& endpoint() const { return endpoint_; }
  std::size_t feeds_open() const { return feeds_open_; }
  void wake();

 private:
  void listen() {
    error_code error;
    const auto address = asio::ip::make_address(options_.address, error);
    const auto check = [&](const char* what) {
      if (!error) return;
      throw OutputError(fmt::format("{} ({})", what, error.message()),
                        fmt::format("{}:{}", options_.address, options_.port),
                        "give another --port or --address, or 0 for any free port");
    };
    check("not an address");
    const tcp::endpoint wanted(address, static_cast<unsigned short>(options_.port));
    acceptor_.open(wanted.protocol(), error);
    check("no server can be opened there");
    keep_to_this_program(acceptor_.native_handle());
    acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    acceptor_.bind(wanted, error);
    check("no server can be opened there");
    acceptor_.listen(asio::socket_base::max_listen_connections, error);
    check("no server can be opened there");
    endpoint_ = acceptor_.local_endpoint();
  }
  void accept();
  /// Handles events until the context is stopped.
  static void run(asio::io_context& context) {
    while (!context.stopped()) {
      try {
        context.run();
      } catch (const std::exception&) {  // out of memory: of one connection, not of the program
      }
    }
  }

  WebServerOptions options_;
  Handler handler_;
  std::map<std::string, FeedMaker> feeds_;
  std::size_t connections_ = 0;             // io_'s thread only, as is all of the connections
  std::set<Socket*> sockets_;               // likewise
  std::atomic<std::size_t> feeds_open_{0};  // sockets_.size(), for others
  std::atomic<bool> waking_{false};         // a wake() is under way
  std::atomic<std::size_t> pending_{0};
  asio::io_context io_{1};  // holds connections when it goes, which tell the above
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;  // of the acceptor
  tcp::endpoint endpoint_;
  asio::io_context maker_io_;  // replies that take time
  asio::executor_work_guard<asio::io_context::executor_type> maker_work_{maker_io_.get_executor()};
  std::jthread io_thread_;
  std::vector<std::jthread> makers_;
};

/// A connection, request by request.
class WebServer::Impl::Http : public std::enable_shared_from_this<Http> {
 public:
  Http(Impl& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    error_code ignored;
    stream_.socket().set_option(tcp::no_delay(true), ignored);
    ++server_.connections_;
  }
  ~Http() { --server_.connections_; }

  void read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(server_.options_.max_header));
    parser_->body_limit(0);
    stream_.expires_after(server_.options_.request_patience);
    http::async_read(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](error_code error, std::size_t) { self->on_request(error); });
  }

 private:
  void on_request(error_code error) {
    if (error == http::error::header_limit) return refuse(431, "the request's header is too long");
    if (error == http::error::body_limit) return refuse(413, "requests have no body here");
    const bool is_gone = error == http::error::end_of_stream || error == beast::error::timeout ||
                         error.category() == asio::error::get_system_category();
    if (error) return is_gone ? close() : refuse(400, "not a request");
    const auto& request = parser_->get();
    is_head_ = request.method() == http::verb::head;
    keep_alive_ = request.keep_alive();
    if (const std::optional<WebResponse> refused = check(request)) return respond(*refused);
    host_ = field(request, http::field::host);
    const std::optional<std::string> path =
        requested_path({request.target().data(), request.target().size()});
    if (!path) return respond(refusal(404, "there is no such thing here"));
    if (websocket::is_upgrade(request)) return upgrade(*path);
    answer(*path);
  }

  static std::string_view field(const http::request<http::string_body>& request, http::field name) {
    const auto value = request[name];
    return {value.data(), value.size()};
  }

  static std::optional<WebResponse> check(const http::request<http::string_body>& request) {
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return refusal(405, "only GET and HEAD are known here");
    }
    const std::string_view host = field(request, http::field::host);
    if (request.count(http::field::host) != 1 || !is_own_host(host)) {
      return refusal(403, "ask for this machine by its address or as localhost");
    }
    const std::string_view origin = field(request, http::field::origin);
    if (request.count(http::field::origin) > 0 && !is_own_origin(origin, host)) {
      return refusal(403, "other sites' pages may not read this one");
    }
    return std::nullopt;
  }

  void upgrade(const std::string& path);

  /// Has the response made by another thread, so that no client waits for another's.
  void answer(const std::string& path) {
    if (++server_.pending_ > server_.options_.max_pending) {
      --server_.pending_;
      return respond(refusal(503, "too many requests wait for an answer"));
    }
    stream_.expires_never();
    // Whoever replies lets go of the connection with that: it ends in io_'s thread.
    const auto held = std::make_shared<std::shared_ptr<Http>>(shared_from_this());
    const Reply reply = [held](WebResponse response) {
      std::shared_ptr<Http> self = std::exchange(*held, nullptr);
      if (!self) return;
      Impl& server = self->server_;
      --server.pending_;
      asio::post(server.io_, [self = std::move(self), response = std::move(response)] {
        self->respond(response);
      });
    };
    asio::post(server_.maker_io_, [&server = server_, reply, path] {
      try {
        server.handler_(path, reply);
      } catch (const std::exception& error) {
        reply(refusal(500, error.what()));
      }
    });
  }

  void refuse(int status, const std::string& why) {
    keep_alive_ = false;  // where the next request begins is not known
    respond(refusal(status, why));
  }

  void respond(const WebResponse& response) {
    body_ = response.body ? response.body : std::make_shared<const std::string>();
    response_.emplace();
    response_->version(11);
    response_->result(static_cast<unsigned>(response.status));
    response_->set(http::field::server, "fovea");
    response_->set(http::field::content_type, response.type);
    // Another map may be shown at this address tomorrow.
    response_->set(http::field::cache_control, "no-store");
    response_->set("X-Content-Type-Options", "nosniff");
    response_->set("Content-Security-Policy", fmt::format(kContentPolicy, host_));
    response_->set("Cross-Origin-Resource-Policy", "same-origin");
    response_->set("Cross-Origin-Opener-Policy", "same-origin");
    response_->set("Referrer-Policy", "no-referrer");
    if (response.status == 405) response_->set(http::field::allow, "GET, HEAD");
    if (response.status == 503) response_->set(http::field::retry_after, "1");
    response_->content_length(body_->size());
    response_->keep_alive(keep_alive_);
    if (!is_head_) response_->body() = {body_->data(), body_->size()};
    stream_.expires_after(server_.options_.response_patience);
    http::async_write(stream_, *response_,
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (error || !self->keep_alive_) return self->close();
                        self->read();
                      });
  }

  void close() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
  }

  Impl& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::span_body<const char>>> response_;
  std::shared_ptr<const std::string> body_;
  std::string host_ = "localhost";
  bool keep_alive_ = false, is_head_ = false;
};

/// A WebSocket that is fed.
class WebServer::Impl::Socket : public std::enable_shared_from_this<Socket> {
 public:
  Socket(Impl& server, beast::tcp_stream stream, std::unique_ptr<WebFeed> feed)
      : server_(server), stream_(std::move(stream)), feed_(std::move(feed)) {
    ++server_.connections_;
    server_.sockets_.insert(this);
    server_.feeds_open_ = server_.sockets_.size();
  }
  ~Socket() {
    --server_.connections_;
    server_.sockets_.erase(this);
    server_.feeds_open_ = server_.sockets_.size();
  }

  void run(const http::request<http::string_body>& request) {
    beast::get_lowest_layer(stream_).expires_never();  // the WebSocket has a clock of its own
    websocket::stream_base::timeout patience{};
    patience.handshake_timeout = server_.options_.request_patience;
    patience.idle_timeout = server_.options_.socket_patience;
    patience.keep_alive_pings = true;
    stream_.set_option(patience);
    stream_.read_message_max(server_.options_.max_message);
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

  /// Asks the feed, unless it is being asked or its message is on its way.
  void feed() {
    if (busy_) {
      again_ = true;
      return;
    }
    busy_ = true;
    again_ = false;
    asio::post(server_.maker_io_, [self = shared_from_this()]() mutable {
      std::optional<WebMessage> message;
      bool failed = false;
      try {
        message = self->feed_->next();
      } catch (const std::exception&) {
        failed = true;  // the client comes again, and begins anew
      }
      // Lets go of itself here: it ends in io_'s thread.
      Impl& server = self->server_;
      asio::post(server.io_, [self = std::move(self), message = std::move(message), failed] {
        if (failed) return self->close();
        self->send(message);
      });
    });
  }

 private:
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->close();
      self->buffer_.clear();  // nothing that a client says is of interest
      self->read();
    });
  }

  void send(const std::optional<WebMessage>& message) {
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

  /// The handlers under way end with errors, and with the last of them the socket is gone.
  void close() {
    error_code ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
  }

  Impl& server_;
  websocket::stream<beast::tcp_stream> stream_;
  std::unique_ptr<WebFeed> feed_;
  beast::flat_buffer buffer_;
  std::shared_ptr<const std::string> sent_;
  bool busy_ = false, again_ = false;
};

void WebServer::Impl::Http::upgrade(const std::string& path) {
  const auto maker = server_.feeds_.find(path);
  if (maker == server_.feeds_.end()) return respond(refusal(404, "there is no WebSocket here"));
  const auto socket = std::make_shared<Socket>(server_, std::move(stream_), maker->second());
  socket->run(parser_->get());
}

void WebServer::Impl::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!error) {
      keep_to_this_program(socket.native_handle());
      // One beyond the limit closes as `socket` goes.
      if (connections_ < options_.max_connections) {
        std::make_shared<Http>(*this, std::move(socket))->read();
      }
      return accept();
    }
    // No files left, say: trying again at once would keep the thread busy with it.
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](error_code) { accept(); });
  });
}

void WebServer::Impl::wake() {
  if (waking_.exchange(true)) return;
  asio::post(io_, [this] {
    waking_ = false;
    for (Socket* socket : sockets_) socket->feed();
  });
}

WebServer::WebServer(const WebServerOptions& options, Handler handler,
                     std::map<std::string, FeedMaker> feeds)
    : impl_(std::make_unique<Impl>(options, std::move(handler), std::move(feeds))) {}

WebServer::~WebServer() = default;

int WebServer::port() const { return impl_->endpoint().port(); }

std::string WebServer::url() const {
  const auto& address = impl_->endpoint().address();
  const std::string host = address.is_unspecified() ? "localhost"
                           : address.is_v6()        ? "[" + address.to_string() + "]"
                                                    : address.to_string();
  return fmt::format("http://{}:{}/", host, port());
}

std::size_t WebServer::feeds_open() const { return impl_->feeds_open(); }

void WebServer::wake() { impl_->wake(); }

void WebServer::stop() { impl_->stop(); }

}  // namespace fovea
