#include "fovea/simulation/world_export.h"

namespace fovea {

World export_world(const Scenery& scenery, const std::set<std::uint32_t>& chunks,
                   const RigidMotion& T_local_world) {
  World world;
  world.materials = scenery.palette().materials;
  for (const std::uint32_t id : chunks) {
    const Chunk chunk = scenery.chunk(id);
    world.mesh_local.append(chunk.mesh_world, T_local_world);
    world.surfaces.insert(chunk.surfaces.begin(), chunk.surfaces.end());
  }
  return world;
}

}  // namespace fovea
