#include "fovea/exporting/mesh/mesh_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <unordered_map>

#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/exporting/mesh/surface_nets.h"
#include "fovea/exporting/tileset/tile_tree.h"

namespace fovea {
namespace {

constexpr double kMinVoxel = 0.01, kMaxVoxel = 10;  // m

/// Poses of the first LiDAR by the frames' numbers.
std::unordered_map<int, RigidMotion> lidar_poses(const MapReader& map) {
  std::unordered_map<int, RigidMotion> T_local_lidar;
  for (const FrameRecord& frame : map.frames()) {
    T_local_lidar.emplace(frame.index, frame.T_local_lidar);
  }
  return T_local_lidar;
}

/// Of a lattice whose blocks lie in one cube, a power of two of them wide, with room on all sides:
/// surface reaches a voxel beyond its points, of the coarsest level too.
Eigen::Vector3d lattice_origin(const Eigen::AlignedBox3d& box, double edge) {
  constexpr double kRoom = 1.1;
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  double cube = 4 * edge;
  while (cube < kRoom * box.sizes().maxCoeff() + 2 * edge) cube *= 2;
  return ((box.center().array() - cube / 2) / edge).floor() * edge;
}

}  // namespace

void MeshOptions::validate() const {
  if (points.crs != Crs::kLocal) throw std::invalid_argument("a mesh's coordinates are local");
  if (voxel >= kMinVoxel && voxel <= kMaxVoxel) return;
  throw ConfigError(fmt::format("a voxel of {} m", voxel), "the mesh's options",
                    fmt::format("give {} to {} m", kMinVoxel, kMaxVoxel));
}

MapBlocks map_blocks(const MapReader& map, const PointStream& points, double voxel,
                     MeshFigures& figures) {
  MapBlocks blocks{PointBlocks(voxel)};
  const double edge = block_edge(voxel);
  blocks.origin = lattice_origin(make_tile_tree(map).box, edge);
  const auto T_local_lidar = lidar_poses(map);
  const std::vector<SensorRecord> sensors = map.sensors();
  points.for_each_block([&](std::span<const ExportPoint> of_tile) {
    std::map<BlockKey, std::vector<SeenPoint>> sorted;
    for (const ExportPoint& point : of_tile) {
      const auto pose = T_local_lidar.find(point.frame);
      if (pose == T_local_lidar.end()) {
        ++figures.without_frame;
        continue;
      }
      Eigen::Vector3d sensor_lidar = Eigen::Vector3d::Zero();
      if (point.sensor < sensors.size()) {
        sensor_lidar = sensors[point.sensor].T_lidar_sensor.translation();
      }
      const Eigen::Array3i block =
          ((point.position - blocks.origin) / edge).array().floor().cast<int>();
      const BlockKey key = BlockKey::of(block);
      SeenPoint seen = seen_point((point.position - blocks.corner(key)).cast<float>(),
                                  (pose->second * sensor_lidar - point.position).cast<float>());
      seen.colored = point.camera != kNoCamera;
      seen.color = point.color;
      sorted[key].push_back(seen);
    }
    for (const auto& [key, of_block] : sorted) {
      blocks.points.append(key, thinned(of_block, blocks.points.cell()));
    }
  });
  return blocks;
}

PointBlocks coarser(const PointBlocks& points) {
  PointBlocks coarse(2 * points.voxel());
  const auto edge = static_cast<float>(block_edge(points.voxel()));
  for (const BlockKey& key : points.keys()) {  // without points: none are kept
    std::vector<SeenPoint> kept = thinned(points.read(key), coarse.cell());
    const Eigen::Array3i half = key.array() - 2 * key.parent().array();
    for (SeenPoint& point : kept) {
      for (std::size_t i = 0; i < 3; ++i) {
        point.position[i] += edge * static_cast<float>(half[Eigen::Index(i)]);
      }
    }
    coarse.append(key.parent(), kept);
  }
  return coarse;
}

BlockMesh mesh_block(const PointBlocks& points, const BlockKey& key) {
  const Surfels surfels(points, key);
  return {surface_nets(surfels, ImplicitSurface(surfels)), surfels.own(), surfels.lonely()};
}

void for_each_block_mesh(const PointBlocks& points,
                         const std::function<void(const BlockKey&, BlockMesh&)>& f) {
  const std::vector<BlockKey> keys = points.keys();
  const std::size_t at_a_time = 2 * static_cast<std::size_t>(available_threads());
  for (std::size_t begin = 0; begin < keys.size(); begin += at_a_time) {
    std::vector<BlockMesh> meshes(std::min(at_a_time, keys.size() - begin));
    parallel_for(meshes.size(), 1,
                 [&](std::size_t i) { meshes[i] = mesh_block(points, keys[begin + i]); });
    for (std::size_t i = 0; i < meshes.size(); ++i) f(keys[begin + i], meshes[i]);
  }
}

void count_block(const BlockMesh& mesh, MeshFigures& figures) {
  figures.cells += mesh.cells;
  figures.lonely_cells += mesh.lonely_cells;
  figures.triangles += mesh.patch.triangles.size();
  for (const MeshVertex& vertex : mesh.patch.vertices) {
    figures.uncolored_vertices += !vertex.colored;
  }
}

}  // namespace fovea
