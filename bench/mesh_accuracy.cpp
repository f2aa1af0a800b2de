// How true the surfaces of `fovea export --format mesh` are: each level of detail of a simulated
// drive's map against the true world, and against the map's own points (docs/exports.md).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/drive/frame_source.h"
#include "fovea/evaluation/truth_poses.h"
#include "fovea/exporting/mesh/mesh_levels.h"
#include "fovea/map/map_store.h"
#include "fovea/world/surface_index.h"
#include "fovea/world/world_file.h"

namespace {

using namespace fovea;

constexpr double kNear = 0.05;  // m, of a point to the mesh

/// The surface as triangles and as points on it about as dense as it has vertices.
struct Level {
  TriangleMesh mesh_local;
  std::vector<Eigen::Vector3d> samples;  // the triangles' middles and corners
  double seconds = 0;
};

Level make_level(const MapBlocks& blocks) {
  Level level;
  const auto begin = std::chrono::steady_clock::now();
  for_each_block_mesh(blocks.points, [&](const BlockKey& key, const BlockMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(level.mesh_local.position.size());
    for (const MeshVertex& vertex : mesh.patch.vertices) {
      level.mesh_local.position.push_back(blocks.corner(key) +
                                          blocks.points.voxel() * place_of(vertex));
    }
    for (const auto& t : mesh.patch.triangles) {
      level.mesh_local.triangle.push_back({first + t[0], first + t[1], first + t[2]});
    }
  });
  level.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  TriangleMesh& mesh = level.mesh_local;
  mesh.texture.resize(mesh.position.size());
  mesh.material.resize(mesh.size());
  mesh.surface.resize(mesh.size());
  level.samples = mesh.position;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    level.samples.push_back((mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3);
  }
  return level;
}

/// Sorted.
std::vector<double> distances(const std::vector<Eigen::Vector3d>& points,
                              const SurfaceIndex& surface, const RigidMotion& T_surface_points) {
  std::vector<double> distance(points.size());
  parallel_for(points.size(), 4096, [&](std::size_t i) {
    const Eigen::Vector3d p = T_surface_points * points[i];
    distance[i] = (surface.nearest(p).position - p).norm();
  });
  std::sort(distance.begin(), distance.end());
  return distance;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

double share_within(const std::vector<double>& sorted, double bound) {
  const auto end = std::upper_bound(sorted.begin(), sorted.end(), bound);
  return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

void measure(const std::string& map_file, const std::string& drive, double finest, int levels) {
  const MapReader map(map_file);
  const DriveTruth truth(open_drive(drive, DriveOptions())->info().path);
  const RigidMotion T_true_map = align_trajectories(pose_pairs(map.frames(), truth));
  const World world = read_world(truth.folder());
  const SurfaceIndex surfaces(world.mesh_local);

  const PointChoice choice;
  const PointStream stream(map, choice);
  std::vector<Eigen::Vector3d> points;
  stream.for_each_block([&](std::span<const ExportPoint> block) {
    for (const ExportPoint& point : block) points.push_back(point.position);
  });
  const auto of_points = distances(points, surfaces, T_true_map);
  fmt::print("points: {}, to the true surface median {:.1f} mm, p95 {:.1f} mm\n", points.size(),
             1e3 * quantile(of_points, 0.5), 1e3 * quantile(of_points, 0.95));
  fmt::print("{:>7} {:>10} {:>10} {:>9} {:>9} {:>13} {:>13} {:>8}\n", "voxel m", "vertices",
             "triangles", "median mm", "p95 mm", "in half voxel", "within 5 cm", "s");
  MeshFigures figures;
  MapBlocks blocks = map_blocks(map, stream, finest, figures);
  for (int i = 0; i < levels; ++i) {
    if (i > 0) blocks.points = coarser(blocks.points);
    const Level level = make_level(blocks);
    if (level.mesh_local.empty()) break;
    const auto to_truth = distances(level.samples, surfaces, T_true_map);
    const auto to_mesh = distances(points, SurfaceIndex(level.mesh_local), RigidMotion::Identity());
    fmt::print("{:7.2f} {:10} {:10} {:9.1f} {:9.1f} {:12.1f}% {:12.1f}% {:8.2f}\n",
               blocks.points.voxel(), level.mesh_local.position.size(), level.mesh_local.size(),
               1e3 * quantile(to_truth, 0.5), 1e3 * quantile(to_truth, 0.95),
               100 * share_within(to_mesh, blocks.points.voxel() / 2),
               100 * share_within(to_mesh, kNear), level.seconds);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Meshes of a simulated drive's map against the truth");
  std::string map, drive;
  double voxel = MeshOptions().voxel;
  int levels = 4;
  app.add_option("MAP.fovea", map)->required();
  app.add_option("DRIVE", drive, "The simulated drive that it was made of")->required();
  app.add_option("--voxel", voxel, "Of the finest level, m")->capture_default_str();
  app.add_option("--levels", levels, "How many")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    measure(map, drive, voxel, levels);
  } catch (const std::exception& error) {
    fmt::print(stderr, "mesh_accuracy: {}\n", error.what());
    return 1;
  }
  return 0;
}
