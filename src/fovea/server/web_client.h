// A client for tests, which can be as rude as they need.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

namespace fovea {

class WebClient {
 public:
  explicit WebClient(int port, int receive_buffer = 0) : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) {
      setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
    }
    const timeval patience{20, 0};
    setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  ~WebClient() { ::close(fd_); }
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  void send(std::string_view bytes) const {
    static_cast<void>(::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }

  /// More bytes; empty when the server has closed the connection (or after 20 s).
  std::string receive() const {
    std::string bytes(65536, '\0');
    const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }
  std::string receive_all() const {
    std::string all;
    for (std::string more; !(more = receive()).empty();) all += more;
    return all;
  }

  struct Response {
    int status = 0;  ///< 0: closed without one
    std::string header, body;
  };
  Response response(bool has_body = true) {
    std::size_t end = std::string::npos;
    while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
      if (!more()) return {};
    }
    Response response{std::atoi(received_.c_str() + 9), received_.substr(0, end + 2), ""};
    received_.erase(0, end + 4);
    const std::size_t length = response.header.find("Content-Length: ");
    if (!has_body || length == std::string::npos) return response;
    const auto size = static_cast<std::size_t>(std::atoll(response.header.c_str() + length + 16));
    while (received_.size() < size) {
      if (!more()) break;
    }
    response.body = received_.substr(0, size);
    received_.erase(0, size);
    return response;
  }
  Response get(const std::string& path, const std::string& headers = "") {
    send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n");
    return response();
  }

  /// Opens a WebSocket; the status of the answer.
  int open_socket(const std::string& path, const std::string& headers = "") {
    return get(path,
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   headers)
        .status;
  }
  struct Message {
    int opcode = -1;  ///< 1 text, 2 binary, 8 close, 9 ping; -1: closed without one
    std::string bytes;
  };
  /// The next message of an open WebSocket, of all its fragments; the server's questions for signs
  /// of life only where they come between messages.
  Message message() {
    Message message;
    bool last = false;
    while (!last) {
      const Message fragment = frame(last);
      if (fragment.opcode < 0) return {};
      const bool is_control = fragment.opcode >= 8;
      if (is_control && message.opcode < 0) return fragment;
      if (is_control) {
        last = false;
        continue;
      }
      if (message.opcode < 0) message.opcode = fragment.opcode;
      message.bytes += fragment.bytes;
    }
    return message;
  }

 private:
  Message frame(bool& last) {
    if (!fill(2)) return {};
    last = (received_[0] & 0x80) != 0;
    std::size_t length = received_[1] & 0x7f, header = 2;
    if (length >= 126) {
      header = length == 126 ? 4 : 10;
      if (!fill(header)) return {};
      length = 0;
      for (std::size_t i = 2; i < header; ++i) {
        length = length << 8 | static_cast<std::uint8_t>(received_[i]);
      }
    }
    if (!fill(header + length)) return {};
    Message message{received_[0] & 0x0f, received_.substr(header, length)};
    received_.erase(0, header + length);
    return message;
  }

  bool more() {
    const std::string bytes = receive();
    received_ += bytes;
    return !bytes.empty();
  }
  bool fill(std::size_t size) {
    while (received_.size() < size) {
      if (!more()) return false;
    }
    return true;
  }

  int fd_;
  std::string received_;
};

}  // namespace fovea
