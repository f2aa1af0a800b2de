#include "fovea/exporting/mesh/mesh_tileset_writer.h"

#include <algorithm>
#include <vector>

#include "fovea/core/output_folder.h"
#include "fovea/exporting/mesh/mesh_gltf.h"
#include "fovea/exporting/mesh/skirts.h"
#include "fovea/exporting/tileset/tileset_json.h"

namespace fovea {
namespace {

/// The octree of blocks: the root is the one block of the coarsest level.
class BlockTree {
 public:
  /// @param keys  of the finest level
  explicit BlockTree(const std::vector<BlockKey>& keys) {
    std::int32_t bits = 0;
    for (const BlockKey& key : keys) bits |= key.x | key.y | key.z;
    for (; bits != 0; bits >>= 1) ++top_;
  }

  int levels() const { return top_ + 1; }

  /// Digits of the path from the root.
  std::string name(int level, const BlockKey& key) const {
    std::string name = "r";
    for (int below = top_ - 1 - level; below >= 0; --below) {
      const auto bit = [&](std::int32_t axis) { return axis >> below & 1; };
      name += static_cast<char>('0' + bit(key.x) + 2 * bit(key.y) + 4 * bit(key.z));
    }
    return name;
  }

 private:
  int top_ = 0;
};

/// A tile that has triangles: its box, in the local frame.
using Boxes = std::map<std::string, Eigen::AlignedBox3d>;

/// The node of that name with all below it that lead to triangles; of an empty box if none does.
/// @param voxel  of the node's level, m
TileNode node_of(const std::string& name, int level, double voxel, const Boxes& boxes) {
  TileNode node{name, level == 0 ? 0 : voxel, Eigen::Vector3d::Zero(), {}};
  const auto first = boxes.lower_bound(name);  // of those whose names begin alike
  if (first == boxes.end() || !first->first.starts_with(name)) return node;
  if (first->first == name) node.box = first->second;
  for (char digit = '0'; level > 0 && digit < '8'; ++digit) {
    TileNode child = node_of(name + digit, level - 1, voxel / 2, boxes);
    if (child.box.isEmpty()) continue;
    node.box.extend(child.box);
    node.children.push_back(std::move(child));
  }
  return node;
}

/// Something thin may have triangles in a node's children only: the node is there, and empty.
void write_empty_tiles(const TileNode& node, const Boxes& boxes, const OutputFolder& folder,
                       std::size_t& tiles) {
  if (node.box.isEmpty()) return;
  if (!boxes.contains(node.name)) {
    folder.write(tile_uri(node.name), empty_glb());
    ++tiles;
  }
  for (const TileNode& child : node.children) write_empty_tiles(child, boxes, folder, tiles);
}

Eigen::AlignedBox3d box_of(const MeshPatch& patch, const Eigen::Vector3d& corner, double voxel) {
  Eigen::AlignedBox3d box;
  for (const MeshVertex& vertex : patch.vertices) box.extend(corner + voxel * place_of(vertex));
  // Also after rounding.
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(voxel / kVoxelSteps);
  return {box.min() - margin, box.max() + margin};
}

}  // namespace

MeshTilesetFigures write_mesh_tileset(const MapReader& map, const std::filesystem::path& path,
                                      const MeshOptions& options,
                                      const std::map<std::string, std::string>& beside) {
  options.validate();
  std::vector<std::string> contents = {"tileset.json", "tiles"};
  for (const auto& [name, bytes] : beside) {
    contents.push_back(std::filesystem::path(name).begin()->string());
  }
  OutputFolder folder(path, options.force, contents);
  const PointStream points(map, options.points);
  MeshTilesetFigures figures{{points.figures()}};
  MapBlocks blocks = map_blocks(map, points, options.voxel, figures);
  const BlockTree tree(blocks.points.keys());
  Boxes boxes;
  for (int level = 0; level < tree.levels(); ++level) {
    if (level > 0) blocks.points = coarser(blocks.points);
    const double voxel = blocks.points.voxel();
    for_each_block_mesh(blocks.points, [&](const BlockKey& key, BlockMesh& mesh) {
      if (level == 0) count_block(mesh, figures);
      if (mesh.patch.empty()) return;
      add_skirts(mesh.patch);
      MeshGltf gltf(MeshCoding::kQuantised);
      const std::string binary = gltf.add(mesh.patch, blocks.corner(key), voxel);
      const std::string name = tree.name(level, key);
      folder.write(tile_uri(name), gltf.head() + binary);
      boxes[name] = box_of(mesh.patch, blocks.corner(key), voxel);
    });
  }
  figures.tiles = boxes.size();
  const TileNode root = node_of("r", tree.levels() - 1, blocks.points.voxel(), boxes);
  write_empty_tiles(root, boxes, folder, figures.tiles);
  folder.write("tileset.json", tileset_json(root, points.georeference().origin(), tile_uri));
  for (const auto& [name, bytes] : beside) folder.write(name, bytes);
  folder.commit();
  return figures;
}

}  // namespace fovea
