// What a scene consists of: chunks of a city along a path, models that stand in them, things that
// move.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/rigid_motion.h"
#include "fovea/simulation/palette.h"
#include "fovea/simulation/path.h"
#include "fovea/simulation/simulation_options.h"
#include "fovea/world/triangle_mesh.h"

namespace fovea {

/// A thing that occurs often, in its own frame (forward, left, up, on the ground).
struct Model {
  std::string kind;   ///< "parked car", "tree", ...
  TriangleMesh mesh;  ///< surface ids are the placement's
  double radius = 0;  ///< of a ball around the origin that holds it (m)
  std::string label;  ///< what KITTI's tracklets call it ("Car", ...); empty where they do not
};

/// A model put somewhere.
struct Placement {
  std::uint32_t model = 0;
  RigidMotion T_world_model = RigidMotion::Identity();
  std::uint16_t paint = Palette::kPaint;  ///< takes the place of material kPaint
  std::uint32_t surface = 0;
};

/// Where a placement is, and what it is made of, in the world.
TriangleMesh placed_mesh(const Model& model, const Placement& placement);

/// A piece of the world with all that stands in it, always the same for the same options and id.
struct Chunk {
  TriangleMesh mesh_world;
  std::map<std::uint32_t, std::string> surfaces;  ///< kind of each surface id in it
  std::vector<Placement> standing;                ///< the models in it that have a label
};

/// Where a chunk lies, known before it is built.
struct ChunkPlace {
  std::uint32_t id = 0;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< world, m
};

class Scenery {
 public:
  virtual ~Scenery() = default;

  const Palette& palette() const { return palette_; }
  const std::vector<Model>& models() const { return models_; }
  /// What the vehicle follows, long enough for the frames asked for.
  const Path& path() const { return *path_; }
  /// Of the vehicle's lane, m to the left of the path.
  virtual double lane_offset() const = 0;
  /// World position of the truth's local frame where the scene fixes it; without it the local frame
  /// is at the LiDAR at frame 0 of pass 0.
  virtual std::optional<Eigen::Vector3d> local_origin() const { return std::nullopt; }

  /// All chunks within `radius` of a place.
  virtual std::vector<ChunkPlace> chunks_near(const Eigen::Vector2d& place,
                                              double radius) const = 0;
  virtual Chunk chunk(std::uint32_t id) const = 0;
  /// Moving things near the vehicle at a time (s), in an order that does not change with it.
  /// @param way  of the vehicle along the path at that time
  virtual std::vector<Placement> movers(double time, double way) const = 0;

  /// Surfaces of movers have this bit.
  static constexpr std::uint32_t kMoving = 0x80000000u;

 protected:
  Palette palette_;
  std::vector<Model> models_;
  std::unique_ptr<Path> path_;
};

std::unique_ptr<Scenery> make_scenery(const SimulationOptions& options);

}  // namespace fovea
