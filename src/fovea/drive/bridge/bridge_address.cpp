#include "fovea/drive/bridge/bridge_address.h"

#include <algorithm>
#include <charconv>

#include "fovea/errors.h"

namespace fovea::bridge {
namespace {

constexpr std::string_view kPlain = "ws://", kEncrypted = "wss://", kDefaultPort = "8765";

bool is_port(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port > 0 && port < 65536;
}

bool has_odd_characters(std::string_view text) {
  for (const char c : text) {
    if (c <= ' ' || c == 0x7f) return true;  // also all beyond ASCII
  }
  return false;
}

}  // namespace

std::string Address::text() const {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + host + "]" : host) + ":" + port;
}

Address parse_address(const std::string& text) {
  const auto fail = [&](const char* problem) -> ConfigError {
    return {problem, text, "give ws://HOST:PORT, as ws://robot:8765"};
  };
  if (text.starts_with(kEncrypted)) throw fail("connections over TLS are not supported");
  if (!text.starts_with(kPlain)) throw fail("this is no address of a bridge");
  if (has_odd_characters(text)) throw fail("the address has characters that no address has");
  std::string_view rest = std::string_view(text).substr(kPlain.size());
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  Address address{"", std::string(kDefaultPort), std::string(rest.substr(slash))};
  if (address.path.empty()) address.path = "/";
  rest = rest.substr(0, slash);
  const std::size_t bracket = rest.starts_with('[') ? rest.find(']') : 0;  // of an IPv6 address
  if (bracket == std::string_view::npos) throw fail("a bracket of the host is not closed");
  const std::size_t colon = rest.find(':', bracket);
  if (bracket > 0 && bracket + 1 != std::min(colon, rest.size())) {
    throw fail("the bracket of the host is not followed by a port");
  }
  address.host = bracket > 0 ? rest.substr(1, bracket - 1) : rest.substr(0, colon);
  if (address.host.empty()) throw fail("the address has no host");
  if (colon != std::string_view::npos) {
    address.port = rest.substr(colon + 1);
    if (!is_port(address.port)) throw fail("the port is no number from 1 to 65535");
  }
  return address;
}

}  // namespace fovea::bridge
