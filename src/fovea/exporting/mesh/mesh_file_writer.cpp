#include "fovea/exporting/mesh/mesh_file_writer.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "fovea/core/output_file.h"
#include "fovea/core/scratch_file.h"
#include "fovea/errors.h"
#include "fovea/exporting/mesh/mesh_gltf.h"

namespace fovea {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;  // bytes copied at a time

}  // namespace

MeshFigures write_mesh_file(const MapReader& map, const std::filesystem::path& path,
                            const MeshOptions& options) {
  options.validate();
  OutputFile file(path, options.force);
  const PointStream points(map, options.points);
  MeshFigures figures{points.figures()};
  const MapBlocks blocks = map_blocks(map, points, options.voxel, figures);
  MeshGltf gltf(MeshCoding::kPlain);
  ScratchFile binary;  // the file begins with what is known in the end
  for_each_block_mesh(blocks.points, [&](const BlockKey& key, const BlockMesh& mesh) {
    count_block(mesh, figures);
    if (mesh.patch.empty()) return;
    const std::string bytes = gltf.add(mesh.patch, blocks.corner(key), options.voxel);
    binary.append(std::vector<char>(bytes.begin(), bytes.end()));
  });
  const std::string head = gltf.head();
  if (head.size() + gltf.binary() > std::numeric_limits<std::uint32_t>::max()) {
    throw OutputError("the mesh is larger than the 4 GiB that a .glb can have", path.string(),
                      "choose larger voxels (--voxel), or write levels of detail (--format mesh)");
  }
  file.stream() << head;
  std::vector<char> piece;
  for (std::size_t done = 0; done < gltf.binary(); done += piece.size()) {
    piece.resize(std::min(kPiece, gltf.binary() - done));
    binary.read(done, std::span(piece));
    file.stream().write(piece.data(), static_cast<std::streamsize>(piece.size()));
  }
  file.commit();
  return figures;
}

}  // namespace fovea
