#include "fovea/server/http_connection.h"

#include <fmt/format.h>

#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "fovea/server/web_request.h"
#include "fovea/server/web_socket.h"

namespace fovea::web {
namespace {

/// The page needs nothing from elsewhere, and nothing elsewhere needs what is here.
constexpr const char* kContentPolicy =
    "default-src 'self'; connect-src 'self' ws://{}; img-src 'self' blob: data:; style-src 'self' "
    "'unsafe-inline'; "
    "worker-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// One connection. It reads and answers one request after the other.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(WebContext& server, tcp::socket socket)
      : server_(server), stream_(std::move(socket)) {
    error_code ignored;
    stream_.socket().set_option(tcp::no_delay(true), ignored);
    ++server_.connections;
  }
  ~HttpConnection() { --server_.connections; }

  void read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(server_.options.max_header));
    parser_->body_limit(0);
    stream_.expires_after(server_.options.request_patience);
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

  void upgrade(const std::string& path) {
    const auto maker = server_.feeds.find(path);
    if (maker == server_.feeds.end()) return respond(refusal(404, "there is no WebSocket here"));
    const auto socket = std::make_shared<WebSocket>(server_, std::move(stream_), maker->second());
    socket->run(parser_->get());
  }

  /// Another thread makes the response, so that no client waits for the response of another.
  void answer(const std::string& path) {
    if (++server_.pending > server_.options.max_pending) {
      --server_.pending;
      return respond(refusal(503, "too many requests wait for an answer"));
    }
    stream_.expires_never();
    // The reply releases the connection, so that it ends in the thread of `io`.
    const auto held = std::make_shared<std::shared_ptr<HttpConnection>>(shared_from_this());
    const WebServer::Reply reply = [held](WebResponse response) {
      std::shared_ptr<HttpConnection> self = std::exchange(*held, nullptr);
      if (!self) return;
      WebContext& server = self->server_;
      --server.pending;
      asio::post(server.io, [self = std::move(self), response = std::move(response)] {
        self->respond(response);
      });
    };
    asio::post(server_.maker_io, [&server = server_, reply, path] {
      try {
        server.handler(path, reply);
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
    stream_.expires_after(server_.options.response_patience);
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

  WebContext& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::span_body<const char>>> response_;
  std::shared_ptr<const std::string> body_;
  std::string host_ = "localhost";
  bool keep_alive_ = false, is_head_ = false;
};

}  // namespace

void serve_connection(WebContext& server, tcp::socket socket) {
  std::make_shared<HttpConnection>(server, std::move(socket))->read();
}

}  // namespace fovea::web
