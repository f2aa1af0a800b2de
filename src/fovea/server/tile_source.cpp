#include "fovea/server/tile_source.h"

#include <utility>

#include "fovea/core/thread.h"
#include "fovea/exporting/tileset/tileset_json.h"

namespace fovea {
namespace {

/// Ends the making of the coarse levels.
struct Stopped {};

}  // namespace

TileSource::TileSource(const std::filesystem::path& map, const ExposureChoice& exposure)
    : tiles_(map, exposure),
      tileset_(shared_bytes(tileset_json(tiles_.root(), std::nullopt,
                                         [](const std::string& name) { return name + ".glb"; }))) {
  if (!tiles_.root().is_leaf()) {
    maker_ = start_thread("fovea-tiles",
                          [this](const std::stop_token& stop) { make_coarse_levels(stop); });
  }
}

TileSource::~TileSource() = default;

double TileSource::read() const {
  return tiles_.root().is_leaf() ? 1 : double(leaves_read_) / double(tiles_.leaves());
}

std::string TileSource::failure() const {
  const std::lock_guard lock(guard_);
  return failure_;
}

void TileSource::make_coarse_levels(const std::stop_token& stop) {
  try {
    tiles_.make_coarse(tiles_.root(), [&](const TileNode& node) {
      if (stop.stop_requested()) throw Stopped();
      if (node.is_leaf()) {
        ++leaves_read_;
      } else {
        deliver(node);
      }
    });
  } catch (const Stopped&) {
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void TileSource::fail(const std::string& failure) {
  std::unordered_map<std::string, std::vector<Receiver>> waiting;
  {
    const std::lock_guard lock(guard_);
    failure_ = failure;
    waiting.swap(waiting_);
  }
  for (const auto& [name, receivers] : waiting) {
    for (const Receiver& receiver : receivers) receiver(nullptr, failure);
  }
}

void TileSource::deliver(const TileNode& node) {
  std::vector<Receiver> receivers;
  {
    const std::lock_guard lock(guard_);
    const auto found = waiting_.find(node.name);
    if (found == waiting_.end()) return;
    receivers.swap(found->second);
    waiting_.erase(found);
  }
  const Bytes tile = tiles_.find_coarse(node);
  for (const Receiver& receiver : receivers) receiver(tile, "");
}

void TileSource::request(const std::string& path, Receiver receiver) {
  constexpr std::string_view kEnding = ".glb";
  if (path == "tileset.json") return receiver(tileset_, "");
  if (!path.ends_with(kEnding)) return receiver(nullptr, "");
  const TileNode* node = tiles_.find(path.substr(0, path.size() - kEnding.size()));
  if (node == nullptr) return receiver(nullptr, "");
  if (node->is_leaf()) return receiver(tiles_.leaf(*node), "");
  Bytes tile;
  std::string failure;
  {
    const std::lock_guard lock(guard_);
    tile = tiles_.find_coarse(*node);
    if (!tile) {
      if (failure_.empty()) {
        waiting_[node->name].push_back(std::move(receiver));
        return;
      }
      failure = failure_;
    }
  }
  receiver(tile, failure);
}

}  // namespace fovea
