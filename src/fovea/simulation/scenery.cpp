#include "fovea/simulation/scenery.h"

namespace fovea {

TriangleMesh placed_mesh(const Model& model, const Placement& placement) {
  TriangleMesh mesh;
  mesh.append(model.mesh, placement.T_world_model);
  for (std::uint16_t& material : mesh.material) {
    if (material == Palette::kPaint) material = placement.paint;
  }
  mesh.surface.assign(mesh.size(), placement.surface);
  return mesh;
}

}  // namespace fovea
