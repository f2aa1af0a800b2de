#include "fovea/server/map_tiles.h"

#include <utility>

#include "fovea/exporting/tileset/glb.h"

namespace fovea {

/// What one thread needs to read points.
struct MapTiles::Reader {
  Reader(const std::filesystem::path& path, const PointChoice& choice)
      : map(path), points(map, choice) {
    // The program that writes the map could not end it while an earlier state is held.
    points.release_state();
  }
  MapReader map;
  PointStream points;
  LeafReader leaves{points};
};

MapTiles::MapTiles(const std::filesystem::path& map, const ExposureChoice& exposure)
    : map_(map), choice_{.include_uncolored = true, .exposure = exposure} {
  auto reader = std::make_unique<Reader>(map, choice_);
  root_ = make_tile_tree(reader->map);
  index(root_);
  idle_readers_.push_back(std::move(reader));
}

MapTiles::~MapTiles() = default;

void MapTiles::index(const TileNode& node) {
  node_of_name_.emplace(node.name, &node);
  leaves_ += node.is_leaf();
  for (const TileNode& child : node.children) index(child);
}

const TileNode* MapTiles::find(const std::string& name) const {
  const auto found = node_of_name_.find(name);
  return found == node_of_name_.end() ? nullptr : found->second;
}

std::unique_ptr<MapTiles::Reader> MapTiles::take_reader() {
  {
    const std::lock_guard lock(guard_);
    if (!idle_readers_.empty()) {
      auto reader = std::move(idle_readers_.back());
      idle_readers_.pop_back();
      return reader;
    }
  }
  return std::make_unique<Reader>(map_, choice_);
}

void MapTiles::put_back(std::unique_ptr<Reader> reader) {
  const std::lock_guard lock(guard_);
  idle_readers_.push_back(std::move(reader));
}

MapTiles::Bytes MapTiles::leaf(const TileNode& leaf) {
  std::unique_ptr<Reader> reader = take_reader();
  auto tile = std::make_shared<const std::string>(make_glb(reader->leaves.read(leaf), true).bytes);
  put_back(std::move(reader));
  return tile;
}

MapTiles::Bytes MapTiles::find_coarse(const TileNode& node) {
  const std::lock_guard lock(guard_);
  const auto found = coarse_.find(node.name);
  if (found == coarse_.end()) return nullptr;
  const std::vector<char> bytes = scratch_.read<char>(found->second);
  return std::make_shared<const std::string>(bytes.begin(), bytes.end());
}

void MapTiles::make_coarse(const TileNode& node, const std::function<void(const TileNode&)>& made) {
  const std::lock_guard one_at_a_time(making_);
  if (find_coarse(node)) return;
  std::unique_ptr<Reader> reader = take_reader();
  for_each_node(node, reader->leaves,
                [&](const TileNode& of, const std::vector<ExportPoint>& points) {
                  if (!of.is_leaf()) {
                    const std::string tile = make_glb(points, true).bytes;
                    const std::lock_guard lock(guard_);
                    coarse_[of.name] = scratch_.append(std::vector<char>(tile.begin(), tile.end()));
                  }
                  made(of);
                });
  put_back(std::move(reader));
}

}  // namespace fovea
