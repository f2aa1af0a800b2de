// What a site shows, by its paths.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace fovea {

/// The JSON files and tiles of docs/viewer-protocol.md. Thread-safe.
class SiteContent {
 public:
  using Bytes = std::shared_ptr<const std::string>;
  /// Receives a file; nullptr if there is none of that name; or the failure.
  using Receiver = std::function<void(Bytes file, const std::string& failure)>;

  virtual ~SiteContent() = default;
  /// Calls `receiver` once: at once, or later from another thread.
  virtual void request(const std::string& path, Receiver receiver) = 0;
};

/// Where the tiles are.
inline constexpr std::string_view kTilesFolder = "tiles/";

inline SiteContent::Bytes shared_bytes(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace fovea
