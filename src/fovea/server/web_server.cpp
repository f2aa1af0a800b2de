#include "fovea/server/web_server.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/steady_timer.hpp>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

#include "fovea/core/thread.h"
#include "fovea/errors.h"
#include "fovea/server/http_connection.h"
#include "fovea/server/web_context.h"
#include "fovea/server/web_socket.h"

namespace fovea {
namespace {

namespace asio = web::asio;
using web::error_code;
using web::tcp;

/// Programs that are started, a browser say, do not keep the port.
void keep_to_this_program(int socket) { static_cast<void>(fcntl(socket, F_SETFD, FD_CLOEXEC)); }

}  // namespace

WebResponse refusal(int status, const std::string& why) {
  return {status, "text/plain; charset=utf-8", std::make_shared<const std::string>(why + "\n")};
}

class WebServer::Impl {
 public:
  Impl(const WebServerOptions& options, Handler handler, std::map<std::string, FeedMaker> feeds)
      : context_(options, std::move(handler), std::move(feeds)),
        acceptor_(context_.io),
        pause_(context_.io) {
    listen();
    accept();
    const ThreadPriority priority =
        options.in_background ? ThreadPriority::kBackground : ThreadPriority::kNormal;
    const auto serve = [this](const std::stop_token&) { run(context_.io); };
    const auto make_replies = [this](const std::stop_token&) { run(context_.maker_io); };
    io_thread_ = start_thread("fovea-serve", serve, priority);
    for (int i = 0; i < options.threads; ++i) {
      makers_.push_back(start_thread("fovea-reply", make_replies, priority));
    }
  }

  ~Impl() { stop(); }

  void stop() {
    if (!io_thread_.joinable()) return;
    context_.io.stop();
    io_thread_.join();
    context_.maker_io.stop();
    makers_.clear();  // joins; the stopped `io` ignores what they still post
  }

  const tcp::endpoint& endpoint() const { return endpoint_; }
  std::size_t feeds_open() const { return context_.feeds_open; }
  void wake();

 private:
  void listen() {
    error_code error;
    const auto address = asio::ip::make_address(context_.options.address, error);
    const auto check = [&](const char* what) {
      if (!error) return;
      throw OutputError(fmt::format("{} ({})", what, error.message()),
                        fmt::format("{}:{}", context_.options.address, context_.options.port),
                        "give another --port or --address, or 0 for any free port");
    };
    check("not an address");
    const tcp::endpoint wanted(address, static_cast<unsigned short>(context_.options.port));
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

  web::WebContext context_;
  std::atomic<bool> waking_{false};  // a wake() is under way
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;  // of the acceptor
  tcp::endpoint endpoint_;
  asio::executor_work_guard<asio::io_context::executor_type> maker_work_{
      context_.maker_io.get_executor()};
  std::jthread io_thread_;
  std::vector<std::jthread> makers_;
};

void WebServer::Impl::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!error) {
      keep_to_this_program(socket.native_handle());
      // One beyond the limit closes as `socket` goes.
      if (context_.connections < context_.options.max_connections) {
        web::serve_connection(context_, std::move(socket));
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
  asio::post(context_.io, [this] {
    waking_ = false;
    for (web::WebSocket* socket : context_.sockets) socket->feed();
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
