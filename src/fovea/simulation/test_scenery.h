// A scenery put together by hand, for tests.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "fovea/simulation/scenery.h"

namespace fovea {

/// Chunks as they are given; a straight path along x; no mover but those asked for.
class TestScenery : public Scenery {
 public:
  TestScenery() {
    const auto zero = [](double) { return 0.0; };
    path_ = std::make_unique<Path>(zero, zero, -500, 500);
    add(Material{});  // kPaint
  }

  std::uint16_t add(const Material& material) {
    palette_.materials.push_back(material);
    return static_cast<std::uint16_t>(palette_.materials.size() - 1);
  }
  std::uint32_t add(Model model) {
    models_.push_back(std::move(model));
    return static_cast<std::uint32_t>(models_.size() - 1);
  }
  void add(const Eigen::Vector2d& center, TriangleMesh mesh_world) {
    chunks_.push_back({center, std::move(mesh_world)});
  }

  double lane_offset() const override { return 0; }
  std::vector<ChunkPlace> chunks_near(const Eigen::Vector2d& place, double radius) const override {
    std::vector<ChunkPlace> near;
    for (std::size_t k = 0; k < chunks_.size(); ++k) {
      if ((chunks_[k].first - place).norm() < radius) {
        near.push_back({static_cast<std::uint32_t>(k), chunks_[k].first});
      }
    }
    return near;
  }
  Chunk chunk(std::uint32_t id) const override {
    ++built;
    return {chunks_.at(id).second, {}, {}};
  }
  std::vector<Placement> movers(double time, double way) const override {
    return moving ? moving(time, way) : std::vector<Placement>{};
  }

  std::function<std::vector<Placement>(double time, double way)> moving;
  mutable int built = 0;  ///< chunks so far

 private:
  std::vector<std::pair<Eigen::Vector2d, TriangleMesh>> chunks_;
};

}  // namespace fovea
