#include "fovea/exporting/mesh/skirts.h"

#include "fovea/core/flat_map.h"

namespace fovea {
namespace {

std::uint64_t edge_key(std::uint32_t from, std::uint32_t to) {
  return std::uint64_t{from} << 31 | to;
}

/// The vertex below another one.
class Hems {
 public:
  explicit Hems(MeshPatch& patch) : patch_(patch) {}

  std::uint32_t below(std::uint32_t vertex) {
    const auto next = static_cast<std::uint32_t>(patch_.vertices.size());
    const auto [number, is_new] = number_.try_emplace(vertex, next);
    if (is_new) {
      MeshVertex hem = patch_.vertices[vertex];
      hem.place -= (kVoxelSteps * hem.normal).array().round().cast<int>();
      patch_.vertices.push_back(hem);
    }
    return *number;
  }

 private:
  MeshPatch& patch_;
  FlatMap<std::uint32_t> number_;
};

}  // namespace

void add_skirts(MeshPatch& patch) {
  FlatMap<char> edges;
  for (const auto& t : patch.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.try_emplace(edge_key(t[i], t[(i + 1) % 3]));
  }
  Hems hems(patch);
  const std::size_t triangles = patch.triangles.size();
  for (std::size_t k = 0; k < triangles; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = patch.triangles[k][i], b = patch.triangles[k][(i + 1) % 3];
      const bool at_face = (patch.vertices[a].faces & patch.vertices[b].faces) != 0;
      if (!at_face || edges.find(edge_key(b, a)) != nullptr) continue;
      const std::uint32_t below_a = hems.below(a), below_b = hems.below(b);
      patch.triangles.push_back({b, a, below_a});
      patch.triangles.push_back({b, below_a, below_b});
    }
  }
}

}  // namespace fovea
