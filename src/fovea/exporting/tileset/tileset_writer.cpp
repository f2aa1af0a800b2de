#include "fovea/exporting/tileset/tileset_writer.h"

#include <stdexcept>
#include <string>

#include "fovea/base/output_folder.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/exporting/tileset/node_points.h"
#include "fovea/exporting/tileset/tileset_json.h"

namespace fovea {
namespace {

std::string uri(const std::string& tile) { return "tiles/" + tile + ".glb"; }

/// Writes the tiles of a tree, children before parents.
class TileWriter {
 public:
  TileWriter(const PointStream& points, const OutputFolder& folder, bool with_sources)
      : leaves_(points), folder_(folder), with_sources_(with_sources) {}

  /// Gives the node and those below it the boxes that their points have; nodes without points are
  /// gone, and a node with one child is that child.
  /// @return what the parent is made of; nothing if the node has no points
  std::vector<ExportPoint> write(TileNode& node) {
    std::vector<ExportPoint> points;
    if (node.is_leaf()) {
      points = leaves_.read(node);
      streamed_ += points.size();
      node.box.setEmpty();
    } else {
      std::vector<TileNode> children;
      for (TileNode& child : node.children) {
        const std::vector<ExportPoint> below = write(child);
        points.insert(points.end(), below.begin(), below.end());
        if (!below.empty()) children.push_back(std::move(child));
      }
      if (children.size() == 1) {
        node = TileNode(std::move(children.front()));
        return points;
      }
      node.children = std::move(children);
      points = thinned(points, node);
      node.box.setEmpty();
      for (const TileNode& child : node.children) node.box.extend(child.box);
    }
    if (!points.empty()) put(node, points);
    return points;
  }

  std::size_t tiles() const { return tiles_; }
  std::size_t streamed() const { return streamed_; }

 private:
  void put(TileNode& node, const std::vector<ExportPoint>& points) {
    Eigen::AlignedBox3d box;
    for (const ExportPoint& point : points) box.extend(point.position);
    const Glb glb = make_glb(points, with_sources_);
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(glb.step);
    node.box.extend(Eigen::AlignedBox3d(box.min() - margin, box.max() + margin));
    folder_.write(uri(node.name), glb.bytes);
    ++tiles_;
  }

  LeafReader leaves_;
  const OutputFolder& folder_;
  bool with_sources_;
  std::size_t tiles_ = 0, streamed_ = 0;
};

}  // namespace

TilesetFigures write_tileset(const MapReader& map, const std::filesystem::path& path,
                             const TilesetOptions& options) {
  if (options.points.crs != Crs::kLocal) {
    throw std::invalid_argument("a tileset's points are local, its root is placed on earth");
  }
  OutputFolder folder(path, options.force, {"tileset.json", "tiles"});
  const PointStream points(map, options.points);
  TileNode root = make_tile_tree(map, options.tree);
  TileWriter writer(points, folder, options.with_sources);
  writer.write(root);
  points.require_all(writer.streamed());
  folder.write("tileset.json", tileset_json(root, points.georeference().origin(), uri));
  folder.commit();
  return {points.figures(), writer.tiles()};
}

}  // namespace fovea
