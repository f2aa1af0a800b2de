#include "fovea/exporting/tileset/tileset_writer.h"

#include <map>
#include <stdexcept>
#include <string>

#include "fovea/core/output_folder.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/exporting/tileset/node_points.h"
#include "fovea/exporting/tileset/tileset_json.h"

namespace fovea {
namespace {

using Boxes = std::map<std::string, Eigen::AlignedBox3d>;

/// Gives the nodes the boxes that their points have; those without any are gone.
/// @param boxes  by name, of the nodes that have points
void fit(TileNode& node, const Boxes& boxes) {
  std::erase_if(node.children, [&](const TileNode& child) { return !boxes.contains(child.name); });
  const auto own = boxes.find(node.name);
  node.box = own == boxes.end() ? Eigen::AlignedBox3d() : own->second;
  for (TileNode& child : node.children) {
    fit(child, boxes);
    node.box.extend(child.box);
  }
}

}  // namespace

TilesetFigures write_tileset(const MapReader& map, const std::filesystem::path& path,
                             const TilesetOptions& options) {
  if (options.points.crs != Crs::kLocal) {
    throw std::invalid_argument("a tileset's points are local, its root is placed on earth");
  }
  std::vector<std::string> contents = {"tileset.json", "tiles"};
  for (const auto& [name, bytes] : options.beside) {
    contents.push_back(std::filesystem::path(name).begin()->string());
  }
  OutputFolder folder(path, options.force, contents);
  const PointStream points(map, options.points);
  TileNode root = make_tile_tree(map, options.tree);
  LeafReader leaves(points);
  Boxes boxes;
  std::size_t streamed = 0;
  for_each_node(root, leaves, [&](const TileNode& node, const std::vector<ExportPoint>& of_node) {
    if (node.is_leaf()) streamed += of_node.size();
    if (of_node.empty()) return;
    const Glb glb = make_glb(of_node, options.with_sources);
    folder.write(tile_uri(node.name), glb.bytes);
    Eigen::AlignedBox3d& box = boxes[node.name];
    for (const ExportPoint& point : of_node) box.extend(point.position);
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(glb.step);
    box = Eigen::AlignedBox3d(box.min() - margin, box.max() + margin);
  });
  points.require_all(streamed);
  fit(root, boxes);
  folder.write("tileset.json", tileset_json(root, points.georeference().origin(), tile_uri));
  for (const auto& [name, bytes] : options.beside) folder.write(name, bytes);
  folder.commit();
  return {points.figures(), boxes.size()};
}

}  // namespace fovea
