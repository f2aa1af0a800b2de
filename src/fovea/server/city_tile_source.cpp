#include "fovea/server/city_tile_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/core/read_file.h"
#include "fovea/exporting/city/city_tileset_json.h"
#include "fovea/exporting/city/city_tileset_writer.h"
#include "fovea/exporting/city/tile_overview.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/exporting/tileset/glb_reader.h"
#include "fovea/exporting/tileset/tileset_json.h"

namespace fovea {
namespace {

constexpr const char *kTileset = "tileset", *kOverview = "overview", *kNodes = "q";
constexpr const char *kJson = ".json", *kGlb = ".glb";
constexpr std::size_t kMostOpenTiles = 8;
constexpr double kGuessedHeight = 1000;  // m, above and below the origin

/// The coarsest level of an overview whose points are at most half the spacing of a node apart: two
/// grids of one spacing would leave holes in each other.
std::size_t level_for(double spacing, double spacing_of_overview) {
  return static_cast<std::size_t>(std::max(0.0, std::log2(spacing / spacing_of_overview) - 1));
}

}  // namespace

CityTileSource::CityTileSource(const City& city, const ExposureChoice& exposure, JobQueue& jobs)
    : city_(city), exposure_(exposure), jobs_(jobs) {
  for (std::size_t i = 0; i < city.tiles.size(); ++i) tile_of_name_.emplace(tile_name(i), i);
  // Reading all overviews of a large city would take too long.
  const bool is_small = city.tiles.size() <= kMostTilesOfTileset;
  root_ = make_city_tree(
      city, [&](std::size_t tile) { return is_small ? shape(tile) : guessed_shape(); });
  index(root_);
  cache("tileset.json", tree_json(root_, "", fmt::format("{}/", kNodes)));
}

CityTileSource::~CityTileSource() = default;

void CityTileSource::index(const CityNode& node) {
  if (!node.tile) node_of_name_.emplace(node.name, &node);
  for (const CityNode& child : node.children) index(child);
}

std::string CityTileSource::tile_name(std::size_t tile) const {
  return city_part_name(city_.tiles[tile].tile);
}

std::string CityTileSource::failure() const {
  const std::lock_guard lock(guard_);
  std::string text;
  for (const auto& [tile, failure] : failures_) text += (text.empty() ? "" : "\n") + failure;
  return text;
}

void CityTileSource::note_failure(std::size_t tile, const std::string& failure) {
  const std::lock_guard lock(guard_);
  failures_[tile] = failure;
}

SiteContent::Bytes CityTileSource::find_cached(const std::string& path) const {
  const std::lock_guard lock(guard_);
  const auto found = cached_.find(path);
  if (found == cached_.end()) return nullptr;
  const std::vector<char> bytes = scratch_.read<char>(found->second);
  return std::make_shared<const std::string>(bytes.begin(), bytes.end());
}

void CityTileSource::cache(const std::string& path, const std::string& bytes) {
  const std::lock_guard lock(guard_);
  cached_[path] = scratch_.append(std::vector<char>(bytes.begin(), bytes.end()));
}

CityTileShape CityTileSource::guessed_shape() const {
  const double spacing = overview_spacing(city_.tile_size);
  const Eigen::Vector3d half(city_.tile_size / 2 + spacing, city_.tile_size / 2 + spacing,
                             kGuessedHeight);
  return {{-half, half}, spacing};
}

CityTileShape CityTileSource::shape(std::size_t tile) {
  CityTileShape shape = guessed_shape();
  const std::filesystem::path file = overview_of_tile(city_.tiles[tile].map);
  try {
    shape.box = std::filesystem::exists(file)
                    ? glb_box(InputFile(file, kStreamedFile).beginning(kGlbHead), file.string())
                    : open_tile(tile)->root().box;
  } catch (const std::exception& error) {
    note_failure(tile, fmt::format("tile {}: {}", city_.tiles[tile].tile.text(), error.what()));
  }
  return shape;
}

std::string CityTileSource::tree_json(const CityNode& root, const std::string& to_tiles,
                                      const std::string& to_nodes) const {
  CityTilesetForm form;
  // Without files of the exposure, the nodes above the parts of a large city have no points: all
  // maps would have to be read.
  form.content = [&](const CityNode& node) {
    const bool has_points = node.tiles <= kMostTilesOfTileset || files_have_exposure();
    return has_points ? to_nodes + node.name + kGlb : std::string();
  };
  form.subtree = [&](const CityNode& node) { return to_nodes + node.name + kJson; };
  form.tile = [&](const CityNode& node) {
    CityTileEntry entry;
    entry.T_parent_entry = city_.T_local_tile(city_.tiles[*node.tile].tile);
    const std::string folder = to_tiles + tile_name(*node.tile) + "/";
    entry.content = folder + kOverview + kGlb;
    entry.below = folder + kTileset + kJson;
    return entry;
  };
  return city_tileset_json(root, form);
}

void CityTileSource::request(const std::string& path, Receiver receiver) {
  if (const Bytes cached = find_cached(path)) return receiver(cached, "");
  jobs_.push([this, path, receiver = std::move(receiver)] {
    Bytes file;
    std::string failure;
    try {
      file = make(path);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    receiver(file, failure);
  });
}

SiteContent::Bytes CityTileSource::make(const std::string& path) {
  const std::size_t slash = path.find('/'), dot = path.rfind('.');
  if (slash == std::string::npos || dot == std::string::npos || dot < slash) return nullptr;
  const std::string folder = path.substr(0, slash), ending = path.substr(dot),
                    name = path.substr(slash + 1, dot - slash - 1);
  if (folder == kNodes) return make_of_tree(name, ending);
  const auto tile = tile_of_name_.find(folder);
  if (tile == tile_of_name_.end()) return nullptr;
  try {
    return make_of_tile(tile->second, name, ending);
  } catch (const std::exception& error) {
    const std::string failure =
        fmt::format("tile {}: {}", city_.tiles[tile->second].tile.text(), error.what());
    note_failure(tile->second, failure);
    throw std::runtime_error(failure);
  }
}

SiteContent::Bytes CityTileSource::make_of_tree(const std::string& name,
                                                const std::string& ending) {
  const auto found = node_of_name_.find(name);
  if (found == node_of_name_.end()) return nullptr;
  if (ending == kGlb) return node_content(*found->second);
  if (ending != kJson) return nullptr;
  CityNode root = *found->second;
  fit_city_tree(root, city_, [&](std::size_t tile) { return shape(tile); });
  return shared_bytes(tree_json(root, "../", ""));
}

SiteContent::Bytes CityTileSource::node_content(const CityNode& node) {
  const std::string path = fmt::format("{}/{}{}", kNodes, node.name, kGlb);
  const std::lock_guard one_at_a_time(making_nodes_);
  if (const Bytes cached = find_cached(path)) return cached;
  std::vector<ExportPoint> points;
  for (const std::size_t tile : tiles_that_show(node)) {
    const std::vector<ExportPoint> of_tile = points_for_node(tile, node);
    points.insert(points.end(), of_tile.begin(), of_tile.end());
  }
  cache(path, make_glb(thinned_to_node(std::move(points), node), true).bytes);
  return find_cached(path);
}

/// Points of a tile that are dense enough for a node. In the city's frame.
std::vector<ExportPoint> CityTileSource::points_for_node(std::size_t tile, const CityNode& node) {
  const CityTile& place = city_.tiles[tile].tile;
  const std::size_t level = level_for(node.spacing, overview_spacing(city_.tile_size));
  try {
    std::vector<ExportPoint> points;
    if (has_overview_file(tile)) {
      points =
          read_glb_level(InputFile(overview_of_tile(city_.tiles[tile].map), kStreamedFile), level);
    } else if (node.tiles <= kMostTilesOfTileset) {
      points = read_glb_level(*overview(tile), level, tile_name(tile));
    }  // else it would take too long to read the maps: the tile is missing from afar
    transform_points(city_.T_local_tile(place), points);
    return points;
  } catch (const std::exception& error) {
    note_failure(tile, fmt::format("tile {}: {}", place.text(), error.what()));
    return {};
  }
}

bool CityTileSource::files_have_exposure() const { return exposure_.kind == kCityExposure.kind; }

bool CityTileSource::has_overview_file(std::size_t tile) const {
  return files_have_exposure() && std::filesystem::exists(overview_of_tile(city_.tiles[tile].map));
}

SiteContent::Bytes CityTileSource::overview(std::size_t tile) {
  const std::filesystem::path& map = city_.tiles[tile].map;
  if (has_overview_file(tile)) {
    const std::vector<std::uint8_t> bytes = read_bytes(overview_of_tile(map));
    return std::make_shared<const std::string>(bytes.begin(), bytes.end());
  }
  const std::string path = fmt::format("{}/{}{}", tile_name(tile), kOverview, kGlb);
  if (const Bytes cached = find_cached(path)) return cached;
  cache(path, make_overview(map, city_.tile_size, exposure_));
  return find_cached(path);
}

std::shared_ptr<MapTiles> CityTileSource::open_tile(std::size_t tile) {
  const std::lock_guard one_at_a_time(opening_);
  {
    const std::lock_guard lock(guard_);
    const auto found = std::find_if(opened_.begin(), opened_.end(),
                                    [&](const auto& opened) { return opened.first == tile; });
    if (found != opened_.end()) {
      opened_.splice(opened_.begin(), opened_, found);
      return opened_.front().second;
    }
  }
  auto tiles = std::make_shared<MapTiles>(city_.tiles[tile].map, exposure_);
  const std::lock_guard lock(guard_);
  opened_.emplace_front(tile, tiles);
  if (opened_.size() > kMostOpenTiles) opened_.pop_back();
  return tiles;
}

SiteContent::Bytes CityTileSource::make_of_tile(std::size_t tile, const std::string& name,
                                                const std::string& ending) {
  if (ending == kGlb && name == kOverview) return overview(tile);
  const std::shared_ptr<MapTiles> tiles = open_tile(tile);
  const TileNode& root = tiles->root();
  if (ending == kJson && name == kTileset) {
    return shared_bytes(tileset_json(root, std::nullopt, [&](const std::string& node) {
      // The overview already shows a root with children.
      return node == root.name && !root.is_leaf() ? "" : node + kGlb;
    }));
  }
  const TileNode* node = ending == kGlb ? tiles->find(name) : nullptr;
  if (node == nullptr) return nullptr;
  if (node->is_leaf()) return tiles->leaf(*node);
  if (!tiles->find_coarse(*node)) tiles->make_coarse(*node, [](const TileNode&) {});
  return tiles->find_coarse(*node);
}

}  // namespace fovea
