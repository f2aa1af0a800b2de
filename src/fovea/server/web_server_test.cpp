#include "fovea/server/web_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "fovea/errors.h"
#include "fovea/server/web_client.h"
#include "fovea/server/web_request.h"

namespace fovea::web_server_test {

using ::testing::HasSubstr;

TEST(WebRequest, OnlyThisMachinesNames) {
  for (const char* host : {"localhost", "LocalHost:8080", "127.0.0.1", "127.0.0.1:80", "[::1]:1",
                           "[::1]", "192.168.1.7:7600", "[fe80::1]:9"}) {
    EXPECT_TRUE(is_own_host(host)) << host;
  }
  for (const char* host :
       {"", "evil.com", "localhost.evil.com", "127.0.0.1.evil.com", "evil.com:80", "localhost:x",
        "localhost:99999", "[::1", "::1", "[]", "127.0.0.1:80:80", "local", "localhostx"}) {
    EXPECT_FALSE(is_own_host(host)) << host;
  }
  EXPECT_TRUE(is_own_origin("http://localhost:7600", "localhost:7600"));
  for (const char* origin : {"http://localhost:7601", "https://localhost:7600", "null", "",
                             "http://evil.com", "http://localhost:7600.evil.com"}) {
    EXPECT_FALSE(is_own_origin(origin, "localhost:7600")) << origin;
  }
}

TEST(WebRequest, PathsStayInside) {
  EXPECT_EQ(requested_path("/"), "");
  EXPECT_EQ(requested_path("/tiles/r07.glb?x=../.."), "tiles/r07.glb");
  EXPECT_EQ(requested_path("/a%2Eb/%63"), "a.b/c");
  for (const char* target : {"",
                             "x",
                             "//x",
                             "/x/",
                             "/./x",
                             "/x/..",
                             "/../x",
                             "/%2e%2e/x",
                             "/x%2f..%2fy",
                             "/x\\y",
                             "/%00",
                             "/a%0",
                             "/a%",
                             "/a%zz",
                             "/a%-1b",
                             "http://localhost/x",
                             "*",
                             "/\xc3\xa4",
                             "/a b",
                             "/a+b"}) {
    EXPECT_EQ(requested_path(target), std::nullopt) << target;
  }
}

/// Echoes paths; "slow" waits for release(), "large" is 3 MB, "bad" throws.
class TestServer : public testing::Test {
 protected:
  void start(WebServerOptions options = {},
             std::map<std::string, WebServer::FeedMaker> feeds = {}) {
    server_.emplace(
        options,
        [this](const std::string& path, const WebServer::Reply& reply) {
          if (path == "slow") {
            const std::lock_guard lock(guard_);
            return waiting_.push_back(reply);
          }
          if (path == "bad") throw std::runtime_error("no such luck");
          std::string body =
              path == "large" ? std::string(3'000'000, 'x') : "you asked for " + path;
          reply({200, "text/plain", std::make_shared<const std::string>(std::move(body))});
        },
        std::move(feeds));
  }
  void TearDown() override {
    if (server_) server_->stop();
    waiting_.clear();
  }
  std::size_t waiting() {
    const std::lock_guard lock(guard_);
    return waiting_.size();
  }
  void release() {
    const std::lock_guard lock(guard_);
    for (const WebServer::Reply& reply : waiting_) reply(refusal(200, "at last"));
    waiting_.clear();
  }
  /// Waits for what another thread brings about.
  template <class Condition>
  static bool comes_true(const Condition& condition) {
    for (int i = 0; i < 2000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  std::mutex guard_;
  std::vector<WebServer::Reply> waiting_;
  std::optional<WebServer> server_;
};

TEST_F(TestServer, AnswersRequestAfterRequest) {
  start();
  WebClient client(server_->port());
  for (const std::string path : {"a", "b/c.d", "large"}) {
    const WebClient::Response response = client.get("/" + path);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.body.size(), path == "large" ? 3'000'000 : 14 + path.size());
    EXPECT_THAT(response.header, HasSubstr("nosniff"));
    EXPECT_THAT(response.header, HasSubstr("default-src 'self'"));
  }
  client.send("HEAD /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(client.response(/*has_body=*/false).header, HasSubstr("Content-Length: 3000000"));
  const WebClient::Response bad = client.get("/bad");
  EXPECT_EQ(bad.status, 500);
  EXPECT_EQ(bad.body, "no such luck\n");
  EXPECT_EQ(client.get("/../x").status, 404);
  EXPECT_EQ(client.get("/x").status, 200);  // the connection lives on
}

TEST_F(TestServer, RefusesWhatIsNotForIt) {
  start();
  const auto status = [&](const std::string& request) {
    WebClient client(server_->port());
    client.send(request);
    return client.response().status;
  };
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: evil.com\r\n\r\n"), 403);
  EXPECT_EQ(status("GET / HTTP/1.1\r\n\r\n"), 403);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.com\r\n\r\n"), 403);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\nOrigin: http://evil.com\r\n\r\n"), 403);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n\r\n"), 200);
  EXPECT_EQ(status("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n"), 405);
  EXPECT_EQ(status("DELETE / HTTP/1.1\r\nHost: localhost\r\n\r\n"), 405);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello"), 413);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
                   "5\r\nhello\r\n0\r\n\r\n"),
            413);
  EXPECT_EQ(
      status("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(9000, 'x') + "\r\n\r\n"),
      431);
  EXPECT_EQ(status("what is this\r\n\r\n"), 400);
  EXPECT_EQ(status(std::string(100, '\0')), 400);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"), 200);
}

TEST_F(TestServer, SlowRequestsAreGivenUp) {
  WebServerOptions options;
  options.request_patience = std::chrono::milliseconds(300);
  start(options);
  const WebClient silent(server_->port()), halting(server_->port());
  halting.send("GET / HTTP/1.1\r\nHost: loc");
  EXPECT_EQ(silent.receive_all(), "");
  EXPECT_EQ(halting.receive_all(), "");
  EXPECT_EQ(WebClient(server_->port()).get("/x").status, 200);
}

TEST_F(TestServer, ResponsesThatNobodyTakesAreGivenUp) {
  WebServerOptions options;
  options.response_patience = std::chrono::milliseconds(300);
  options.max_connections = 1;
  start(options);
  const WebClient deaf(server_->port(), 4096);
  deaf.send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_TRUE(comes_true([&] { return WebClient(server_->port()).get("/x").status == 200; }));
}

TEST_F(TestServer, OneSlowAnswerKeepsNobodyWaiting) {
  start();
  WebClient slow(server_->port());
  slow.send("GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_TRUE(comes_true([&] { return waiting() == 1; }));
  EXPECT_EQ(WebClient(server_->port()).get("/x").status, 200);
  release();
  EXPECT_EQ(slow.response().body, "at last\n");
}

TEST_F(TestServer, TooManyRequestsAtATime) {
  WebServerOptions options;
  options.max_pending = 3;
  start(options);
  std::vector<std::unique_ptr<WebClient>> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(std::make_unique<WebClient>(server_->port()));
    clients.back()->send("GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  ASSERT_TRUE(comes_true([&] { return waiting() == 3; }));
  EXPECT_EQ(WebClient(server_->port()).get("/x").status, 503);
  release();
  for (const auto& client : clients) EXPECT_EQ(client->response().status, 200);
  EXPECT_EQ(WebClient(server_->port()).get("/x").status, 200);
}

TEST_F(TestServer, AHundredConnections) {
  start();
  std::vector<std::unique_ptr<WebClient>> clients;
  for (int i = 0; i < 100; ++i) clients.push_back(std::make_unique<WebClient>(server_->port()));
  for (const auto& client : clients) {
    client->send("GET /x HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  for (const auto& client : clients) EXPECT_EQ(client->response().body, "you asked for x");
}

TEST_F(TestServer, ConnectionsBeyondTheLimitAreClosed) {
  WebServerOptions options;
  options.max_connections = 10;
  start(options);
  std::vector<std::unique_ptr<WebClient>> clients;
  for (int i = 0; i < 10; ++i) {
    clients.push_back(std::make_unique<WebClient>(server_->port()));
    EXPECT_EQ(clients.back()->get("/x").status, 200);
  }
  EXPECT_EQ(WebClient(server_->port()).get("/x").status, 0);
  clients.clear();
  EXPECT_TRUE(comes_true([&] { return WebClient(server_->port()).get("/x").status == 200; }));
}

TEST_F(TestServer, ReplyingAfterTheClientHasGone) {
  start();
  {
    WebClient client(server_->port());
    client.send("GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(comes_true([&] { return waiting() == 1; }));
  }
  release();
  EXPECT_EQ(WebClient(server_->port()).get("/x").status, 200);
}

TEST_F(TestServer, EndsWhileRequestsWait) {
  start();
  WebClient client(server_->port());
  client.send("GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_TRUE(comes_true([&] { return waiting() == 1; }));
  server_->stop();
  waiting_.clear();
  server_.reset();
  EXPECT_EQ(client.receive_all(), "");
}

TEST_F(TestServer, APortOnce) {
  start();
  WebServerOptions options;
  options.port = server_->port();
  const WebServer::Handler none = [](const std::string&, const WebServer::Reply&) {};
  EXPECT_THROW(WebServer(options, none), OutputError);
  options.address = "not an address";
  EXPECT_THROW(WebServer(options, none), OutputError);
  options = {.address = "192.0.2.1"};  // for documentation: nobody has it
  EXPECT_THROW(WebServer(options, none), OutputError);
  EXPECT_EQ(server_->url(), "http://127.0.0.1:" + std::to_string(server_->port()) + "/");
}

/// Messages "0", "1", ... up to what is there.
class Counter : public WebFeed {
 public:
  Counter(const std::atomic<int>& there, std::size_t size) : there_(there), size_(size) {}
  std::optional<WebMessage> next() override {
    if (sent_ == there_) return std::nullopt;
    std::string text = std::to_string(sent_++);
    text.resize(std::max(size_, text.size()), ' ');
    return WebMessage{std::make_shared<const std::string>(std::move(text)), sent_ % 2 == 0};
  }

 private:
  const std::atomic<int>& there_;
  std::size_t size_;
  int sent_ = 0;
};

class FeedServer : public TestServer {
 protected:
  void start_feed(const WebServerOptions& options = {}, std::size_t size = 0) {
    start(options, {{"live", [this, size] { return std::make_unique<Counter>(there_, size); }}});
  }
  std::atomic<int> there_{0};
};

TEST_F(FeedServer, EveryMessageOnceInOrder) {
  there_ = 3;
  start_feed();
  WebClient client(server_->port());
  ASSERT_EQ(client.open_socket("/live"), 101);
  for (int i = 0; i < 1000; ++i) {
    if (i >= 3) {
      there_ = i + 1;
      server_->wake();
    }
    const WebClient::Message message = client.message();
    ASSERT_EQ(message.bytes, std::to_string(i));
    ASSERT_EQ(message.opcode, i % 2 == 0 ? 1 : 2);
  }
  EXPECT_EQ(server_->feeds_open(), 1u);
}

TEST_F(FeedServer, OnlyWhereItIsAndForItsOwnPage) {
  start_feed();
  EXPECT_EQ(WebClient(server_->port()).open_socket("/elsewhere"), 404);
  EXPECT_EQ(WebClient(server_->port()).open_socket("/live", "Origin: http://evil.com\r\n"), 403);
  EXPECT_EQ(WebClient(server_->port()).open_socket("/live", "Origin: http://localhost\r\n"), 101);
}

TEST_F(FeedServer, AClientThatNeverReadsHoldsUpNobody) {
  start_feed({}, 100'000);
  WebClient deaf(server_->port(), 4096), keen(server_->port());
  ASSERT_EQ(deaf.open_socket("/live"), 101);
  ASSERT_EQ(keen.open_socket("/live"), 101);
  for (int i = 0; i < 300; ++i) {  // 30 MB
    there_ = i + 1;
    server_->wake();
    ASSERT_EQ(keen.message().bytes.size(), 100'000u);
  }
}

TEST_F(FeedServer, ASilentClientIsLetGo) {
  WebServerOptions options;
  options.socket_patience = std::chrono::milliseconds(300);
  start_feed(options);
  WebClient client(server_->port());
  ASSERT_EQ(client.open_socket("/live"), 101);
  EXPECT_EQ(client.message().opcode, 9);  // it is asked
  EXPECT_TRUE(comes_true([&] { return server_->feeds_open() == 0; }));
}

TEST_F(FeedServer, MalformedFramesCloseOnlyTheirOwnSocket) {
  there_ = 1;
  start_feed();
  WebClient good(server_->port());
  ASSERT_EQ(good.open_socket("/live"), 101);
  EXPECT_EQ(good.message().bytes, "0");
  using namespace std::string_view_literals;
  for (const std::string_view frame :
       {"\x81\x05hello"sv,                                     // not masked
        "\xf1\x80\0\0\0\0"sv,                                  // reserved bits
        "\x8f\x80\0\0\0\0"sv,                                  // unknown opcode
        "\x89\xfe\x01\x00\0\0\0\0"sv,                          // a ping of 256 bytes
        "\x82\xff\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0"sv,  // of 2^64 - 1 bytes
        "\x82\xfe\x20\x00\0\0\0\0"sv,                          // of 8 kB: more than it takes
        "\x81\x82\0\0\0\0\xff\xfe"sv,                          // not UTF-8
        "\x80\x80\0\0\0\0"sv}) {                               // continues nothing
    WebClient client(server_->port());
    ASSERT_EQ(client.open_socket("/live"), 101);
    client.send(frame);
    client.receive_all();  // ends: the server has closed it
  }
  EXPECT_TRUE(comes_true([&] { return server_->feeds_open() == 1; }));
  good.send("\x81\x85\0\0\0\0hello"sv);  // what a client says is dropped
  there_ = 2;
  server_->wake();
  EXPECT_EQ(good.message().bytes, "1");
}

TEST_F(FeedServer, EndsWithSocketsOpen) {
  there_ = 5;
  start_feed({}, 1'000'000);
  WebClient reading(server_->port()), deaf(server_->port(), 4096);
  ASSERT_EQ(reading.open_socket("/live"), 101);
  ASSERT_EQ(deaf.open_socket("/live"), 101);
  reading.message();
  server_.reset();
  while (reading.message().opcode >= 0) {
  }
}

TEST_F(FeedServer, AFeedThatFailsClosesItsSocket) {
  class Failing : public WebFeed {
    std::optional<WebMessage> next() override { throw std::runtime_error("the file is gone"); }
  };
  start({}, {{"live", [] { return std::make_unique<Failing>(); }}});
  WebClient client(server_->port());
  ASSERT_EQ(client.open_socket("/live"), 101);
  EXPECT_EQ(client.message().opcode, -1);
  EXPECT_TRUE(comes_true([&] { return server_->feeds_open() == 0; }));
}

}  // namespace fovea::web_server_test
