#include "fovea/exporting/city/city_tileset_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "fovea/core/errors.h"
#include "fovea/core/output_file.h"
#include "fovea/core/output_folder.h"
#include "fovea/core/read_file.h"
#include "fovea/exporting/city/city_tileset_json.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/exporting/tileset/glb_reader.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTileset = "tileset.json";
constexpr const char* kNodes = "q";  // folder of the levels above the tiles

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
    OutputFolder nodes(folder_ / kNodes, /*force=*/true, names_of_nodes());
    CityRootFigures figures;
    for_each_city_node(
        root_, [&](const CityNode& node) { return points_of_tile(node); },
        [&](const CityNode& node, const std::vector<ExportPoint>& points) {
          if (points.empty()) return;
          nodes.write(node.name + ".glb", make_glb(points, options_.with_sources).bytes);
          ++figures.nodes;
        });
    write_subtrees(root_, nodes);
    nodes.commit();
    for (const auto& [name, bytes] : options_.beside) write_file(name, bytes);
    write_file(kTileset, city_tileset_json(root_, form("", fs::path(kNodes) / "")));
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
  void write_subtrees(const CityNode& node, OutputFolder& nodes) const {
    for (const CityNode& child : node.children) {
      if (child.tiles > kMostTilesOfTileset) {
        write_subtrees(child, nodes);
      } else if (begins_tileset(child, node.tiles)) {
        nodes.write(child.name + ".json", city_tileset_json(child, form("../", "")));
      }
    }
  }

  /// All names that the folder of nodes may have, of this root or an earlier one.
  std::vector<std::string> names_of_nodes() const {
    std::vector<std::string> names;
    const std::function<void(const CityNode&)> add = [&](const CityNode& node) {
      names.push_back(node.name + ".glb");
      names.push_back(node.name + ".json");
      for (const CityNode& child : node.children) add(child);
    };
    add(root_);
    for (const fs::path& folder : {folder_ / kNodes, partial_path(folder_ / kNodes)}) {
      std::error_code error;
      for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string(),
                          ending = entry.path().extension().string();
        const bool is_node = name.starts_with("q") && (ending == ".glb" || ending == ".json");
        if (is_node) names.push_back(name);
      }
    }
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
