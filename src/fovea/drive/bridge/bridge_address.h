// Where a bridge listens.
#pragma once

#include <string>
#include <string_view>

namespace fovea::bridge {

struct Address {
  std::string host, port, path;

  /// "robot:8765", "[::1]:8765".
  std::string text() const;
};

/// Whether a text is meant as an address, not as a file: "ws://..." or "wss://...".
inline bool is_address(std::string_view text) {
  return text.starts_with("ws://") || text.starts_with("wss://");
}

/// Reads "ws://HOST[:PORT][/PATH]". The port is 8765 by default, as of the bridge.
/// ConfigError if it is no such address.
Address parse_address(const std::string& text);

}  // namespace fovea::bridge
