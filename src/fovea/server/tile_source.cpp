#include "fovea/server/tile_source.h"

#include <utility>

#include "fovea/core/thread.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/exporting/tileset/tileset_json.h"

namespace fovea {
namespace {

/// Ends the making of the coarse levels.
struct Stopped {};

}  // namespace

/// What one thread needs to read points.
struct TileSource::Reader {
  Reader(const std::filesystem::path& path, const PointChoice& choice)
      : map(path), points(map, choice) {
    // The program that writes the map could not end it while an earlier state is held.
    points.release_state();
  }
  MapReader map;
  PointStream points;
  LeafReader leaves{points};
};

TileSource::TileSource(const std::filesystem::path& map, const ExposureChoice& exposure)
    : map_(map), choice_{.include_uncolored = true, .exposure = exposure} {
  auto reader = std::make_unique<Reader>(map, choice_);
  root_ = make_tile_tree(reader->map);
  index(root_);
  tileset_ = std::make_shared<const std::string>(
      tileset_json(root_, std::nullopt, [](const std::string& name) { return name + ".glb"; }));
  idle_readers_.push_back(std::move(reader));
  if (!root_.is_leaf()) {
    maker_ = start_thread("fovea-tiles",
                          [this](const std::stop_token& stop) { make_coarse_levels(stop); });
  }
}

TileSource::~TileSource() = default;

void TileSource::index(const TileNode& node) {
  node_of_name_.emplace(node.name, &node);
  leaves_ += node.is_leaf();
  for (const TileNode& child : node.children) index(child);
}

double TileSource::read() const {
  return root_.is_leaf() ? 1 : double(leaves_read_) / double(leaves_);
}

std::string TileSource::failure() const {
  const std::lock_guard lock(guard_);
  return failure_;
}

void TileSource::make_coarse_levels(const std::stop_token& stop) {
  try {
    Reader reader(map_, choice_);
    for_each_node(root_, reader.leaves,
                  [&](const TileNode& node, const std::vector<ExportPoint>& points) {
                    if (stop.stop_requested()) throw Stopped();
                    if (node.is_leaf()) {
                      ++leaves_read_;
                    } else {
                      keep(node, points);
                    }
                  });
  } catch (const Stopped&) {
  } catch (const std::exception& error) {
    std::unordered_map<std::string, std::vector<Receiver>> waiting;
    {
      const std::lock_guard lock(guard_);
      failure_ = error.what();
      waiting.swap(waiting_);
    }
    for (const auto& [name, receivers] : waiting) {
      for (const Receiver& receiver : receivers) receiver(nullptr, error.what());
    }
  }
}

void TileSource::keep(const TileNode& node, const std::vector<ExportPoint>& points) {
  const Bytes tile = std::make_shared<const std::string>(make_glb(points, true).bytes);
  std::vector<Receiver> receivers;
  {
    const std::lock_guard lock(guard_);
    coarse_[node.name] = scratch_.append(std::vector<char>(tile->begin(), tile->end()));
    const auto found = waiting_.find(node.name);
    if (found != waiting_.end()) {
      receivers.swap(found->second);
      waiting_.erase(found);
    }
  }
  for (const Receiver& receiver : receivers) receiver(tile, "");
}

TileSource::Bytes TileSource::read_coarse(const ScratchFile::Place& place) {
  const std::vector<char> bytes = scratch_.read<char>(place);
  return std::make_shared<const std::string>(bytes.begin(), bytes.end());
}

TileSource::Bytes TileSource::make_leaf(const TileNode& leaf) {
  std::unique_ptr<Reader> reader;
  {
    const std::lock_guard lock(guard_);
    if (!idle_readers_.empty()) {
      reader = std::move(idle_readers_.back());
      idle_readers_.pop_back();
    }
  }
  if (!reader) reader = std::make_unique<Reader>(map_, choice_);
  Bytes tile = std::make_shared<const std::string>(make_glb(reader->leaves.read(leaf), true).bytes);
  const std::lock_guard lock(guard_);
  idle_readers_.push_back(std::move(reader));
  return tile;
}

void TileSource::request(const std::string& name, Receiver receiver) {
  const auto found = node_of_name_.find(name);
  if (found == node_of_name_.end()) return receiver(nullptr, "");
  if (found->second->is_leaf()) return receiver(make_leaf(*found->second), "");
  Bytes tile;
  std::string failure;
  {
    const std::lock_guard lock(guard_);
    const auto coarse = coarse_.find(name);
    if (coarse != coarse_.end()) {
      tile = read_coarse(coarse->second);
    } else if (failure_.empty()) {
      waiting_[name].push_back(std::move(receiver));
      return;
    } else {
      failure = failure_;
    }
  }
  receiver(tile, failure);
}

}  // namespace fovea
