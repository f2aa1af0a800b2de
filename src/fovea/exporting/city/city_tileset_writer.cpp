#include "fovea/exporting/city/city_tileset_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fovea/core/output_file.h"
#include "fovea/core/output_folder.h"
#include "fovea/core/read_file.h"
#include "fovea/errors.h"
#include "fovea/exporting/city/city_tileset_json.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/exporting/tileset/glb_reader.h"
#include "fovea/map/value_hash.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTileset = "tileset.json";
constexpr const char* kNodes = "q";       // folder of the levels above the tiles
constexpr const char* kNodePrefix = "q";  // begins the names of their files
constexpr const char* kNewNodes = "new";  // levels that have no hash yet
constexpr std::size_t kHashDigits = 16;

/// What the root must know of a tile's part.
struct Part {
  CityTileShape shape;
  fs::path content;  // points of its coarsest level; empty: it has none
};

constexpr const char* kExportPart = "export the tile's map to this folder (--format 3dtiles)";

Part read_tileset(const fs::path& folder) {
  const nlohmann::json root = nlohmann::json::parse(read_text(folder / kTileset)).at("root");
  Part part;
  if (!root.contains("content")) return part;
  const auto box = root.at("boundingVolume").at("box").get<std::array<double, 12>>();
  const Eigen::Vector3d center(box[0], box[1], box[2]), half(box[3], box[7], box[11]);
  part.shape.box = {center - half, center + half};
  part.shape.spacing = root.at("geometricError").get<double>();
  if (!center.allFinite() || !half.allFinite() || !(part.shape.spacing >= 0)) {
    throw std::invalid_argument("its root is impossible");
  }
  const fs::path content = root.at("content").at("uri").get<std::string>();
  const bool leaves = std::find(content.begin(), content.end(), "..") != content.end();
  if (content.is_absolute() || leaves) throw std::invalid_argument("its content lies elsewhere");
  part.content = folder / content;
  return part;
}

Part read_part(const fs::path& folder, const CityTile& tile) {
  if (!fs::is_regular_file(folder / kTileset)) {
    throw InputError(fmt::format("the part of tile {} is missing", tile.text()), folder.string(),
                     kExportPart);
  }
  try {
    return read_tileset(folder);
  } catch (const std::exception& error) {
    throw InputError(fmt::format("the part of tile {} is damaged ({})", tile.text(), error.what()),
                     (folder / kTileset).string(), kExportPart);
  }
}

bool is_node_file(const fs::path& name) {
  const bool has_ending = name.extension() == ".glb" || name.extension() == ".json";
  return has_ending && name.string().starts_with(kNodePrefix);
}

bool is_hash(const std::string& name) {
  return name.size() == kHashDigits &&
         name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) entries.push_back(entry.path());
  return entries;
}

/// Files of nodes that grow in one folder. The folder's name is a hash of its contents, so that a
/// tileset never refers to nodes of another one.
class NodeFolder {
 public:
  /// @param nodes  folder of all such folders
  /// @param names  of the files to write
  NodeFolder(const fs::path& nodes, std::vector<std::string> names)
      : nodes_(nodes), folder_(nodes / kNewNodes, /*force=*/true, with_earlier(std::move(names))) {}

  void write(const std::string& name, const std::string& bytes) {
    folder_.write(name, bytes);
    hash_.row();
    hash_.value(std::string_view(name));
    hash_.value(std::string_view(bytes));
  }
  /// @return the folder's name
  std::string commit() {
    std::string name = fmt::format("{:0{}x}", hash_.hash64(), kHashDigits);
    folder_.commit_as(name);
    return name;
  }
  /// Removes the nodes of earlier roots. Files of something else stay.
  void remove_others(const std::string& kept) const {
    std::error_code ignored;
    for (const fs::path& entry : entries_of(nodes_)) {
      const std::string name = entry.filename().string();
      if (is_node_file(name)) fs::remove(entry, ignored);  // of an earlier version
      if (!is_hash(name) || name == kept) continue;
      for (const fs::path& file : entries_of(entry)) {
        if (is_node_file(file.filename())) fs::remove(file, ignored);
      }
      fs::remove(entry, ignored);  // if it is empty
    }
  }

 private:
  /// With all names that earlier folders have, so that these can be replaced.
  std::vector<std::string> with_earlier(std::vector<std::string> names) const {
    std::error_code error;
    fs::create_directory(nodes_, error);
    if (error) throw_output_error(nodes_, error.value());
    for (const fs::path& folder : entries_of(nodes_)) {
      for (const fs::path& file : entries_of(folder)) {
        if (is_node_file(file.filename())) names.push_back(file.filename().string());
      }
    }
    return names;
  }

  fs::path nodes_;
  OutputFolder folder_;
  ValueHash hash_;
};

class RootWriter {
 public:
  RootWriter(const City& city, const fs::path& folder, const CityRootOptions& options)
      : city_(city), folder_(folder), options_(options) {
    check_output_path(folder / kTileset, options.force);
    for (const CityTileFile& tile : city.tiles) {
      parts_.push_back(read_part(folder / part_name(tile), tile.tile));
    }
    root_ = make_city_tree(city, [&](std::size_t tile) { return parts_[tile].shape; });
  }

  CityRootFigures write() {
    NodeFolder nodes(folder_ / kNodes, names_of_nodes());
    CityRootFigures figures;
    for_each_city_node(
        root_, [&](const CityNode& node) { return points_of_tile(node); },
        [&](const CityNode& node, const std::vector<ExportPoint>& points) {
          if (points.empty()) return;
          nodes.write(node.name + ".glb", make_glb(points, options_.with_sources).bytes);
          ++figures.nodes;
        });
    write_subtrees(root_, nodes);
    const std::string of_nodes = nodes.commit();
    for (const auto& [name, bytes] : options_.beside) write_file(name, bytes);
    // Until now the earlier tileset is whole, and from now on this one.
    write_file(kTileset,
               city_tileset_json(root_, form("", fmt::format("{}/{}/", kNodes, of_nodes))));
    nodes.remove_others(of_nodes);
    return figures;
  }

 private:
  std::string part_name(const CityTileFile& tile) const {
    const std::string of_map = tile.map.stem().string();
    return fs::is_directory(folder_ / of_map) ? of_map : city_part_name(tile.tile);
  }

  /// In the city's frame. Nothing if the node is no tile.
  std::optional<std::vector<ExportPoint>> points_of_tile(const CityNode& node) const {
    if (!node.tile) return std::nullopt;
    const Part& part = parts_[*node.tile];
    if (part.content.empty()) return std::vector<ExportPoint>();
    const std::vector<std::uint8_t> bytes = read_bytes(part.content);
    std::vector<ExportPoint> points = read_glb(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, part.content.string());
    transform_points(city_.T_local_tile(city_.tiles[*node.tile].tile), points);
    return points;
  }

  /// @param to_folder  address of the city's folder from that of the tileset
  /// @param to_nodes   the same of the folder of nodes
  CityTilesetForm form(const std::string& to_folder, const std::string& to_nodes) const {
    CityTilesetForm form;
    if (to_folder.empty()) form.T_parent_root = T_ecef_enu(city_.origin);
    form.content = [=](const CityNode& node) { return to_nodes + node.name + ".glb"; };
    form.subtree = [=](const CityNode& node) { return to_nodes + node.name + ".json"; };
    form.tile = [=, this](const CityNode& node) {
      const CityTileFile& tile = city_.tiles[*node.tile];
      CityTileEntry entry;
      // The part's own root places it on earth.
      entry.T_parent_entry = T_ecef_enu(city_.origin).inverse();
      entry.T_entry_tile = T_ecef_enu(city_.origin) * city_.T_local_tile(tile.tile);
      entry.content = to_folder + part_name(tile) + "/" + kTileset;
      return entry;
    };
    return form;
  }

  /// Tilesets of their own, each with all nodes below it.
  void write_subtrees(const CityNode& node, NodeFolder& nodes) const {
    for (const CityNode& child : node.children) {
      if (child.tiles > kMostTilesOfTileset) {
        write_subtrees(child, nodes);
      } else if (begins_tileset(child, node.tiles)) {
        nodes.write(child.name + ".json", city_tileset_json(child, form("../../", "")));
      }
    }
  }

  /// All names that the files of nodes may have.
  std::vector<std::string> names_of_nodes() const {
    std::vector<std::string> names;
    const std::function<void(const CityNode&)> add = [&](const CityNode& node) {
      names.push_back(node.name + ".glb");
      names.push_back(node.name + ".json");
      for (const CityNode& child : node.children) add(child);
    };
    add(root_);
    return names;
  }

  void write_file(const fs::path& name, const std::string& bytes) const {
    const fs::path path = folder_ / name;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    OutputFile file(path, options_.force);
    file.stream() << bytes;
    file.commit();
  }

  const City& city_;
  const fs::path& folder_;
  const CityRootOptions& options_;
  std::vector<Part> parts_;  // by the number of the tile
  CityNode root_;
};

}  // namespace

std::string city_part_name(const CityTile& tile) { return fmt::format("{}_{}", tile.x, tile.y); }

CityRootFigures write_city_root(const City& city, const fs::path& folder,
                                const CityRootOptions& options) {
  return RootWriter(city, folder, options).write();
}

}  // namespace fovea
