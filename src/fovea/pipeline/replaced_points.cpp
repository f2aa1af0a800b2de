#include "fovea/pipeline/replaced_points.h"

#include <vector>

#include "fovea/core/parallel.h"
#include "fovea/pipeline/view_frustum.h"

namespace fovea {
namespace {

struct CoarseTile {
  TileId id;
  const TilePoints* points;
  std::vector<std::uint32_t> kept;
};

bool has_its_turn(const TileKey& key, int frame) {
  return ((key.x + key.y + key.z + frame / 2) & 3) == 0;
}

std::vector<std::uint32_t> find_replaced(const TileMap& map, const Occupancy& occupancy,
                                         const CoarseTile& tile) {
  const TilePoints& points = *tile.points;
  const RigidMotion T_last_tile = map.submaps().back().T_local_submap.inverse() *
                                  map.submaps()[tile.id.submap].T_local_submap *
                                  Eigen::Translation3d(points.origin);
  std::vector<std::uint32_t> replaced;
  points.sampling_level.for_each_run([&](std::uint32_t begin, std::uint32_t end, int level) {
    for (std::uint32_t i = begin; level > 0 && i < end; ++i) {
      const Eigen::Vector3d p_tile =
          points.position_at(i).cast<double>().array() + kStepsOn * double(kPositionStep);
      const Eigen::Vector3d p_last = T_last_tile * p_tile;
      if (occupancy.holds_point(p_last, level, level - 1)) replaced.push_back(i);
    }
  });
  return replaced;
}

/// The numbers below `count` that are not among some ascending ones.
std::vector<std::uint32_t> all_but(const std::vector<std::uint32_t>& some, std::size_t count) {
  std::vector<std::uint32_t> others;
  others.reserve(count - some.size());
  auto next = some.begin();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (next != some.end() && *next == i) {
      ++next;
    } else {
      others.push_back(i);
    }
  }
  return others;
}

}  // namespace

std::size_t remove_replaced_points(TileMap& map, const Occupancy& occupancy, const Camera& camera,
                                   const RigidMotion& T_local_cam, double reach, int frame,
                                   DynamicPointFilter& filter) {
  const RigidMotion T_cam_local = T_local_cam.inverse();
  std::vector<CoarseTile> tiles;
  map.for_each_tile_near(
      T_local_cam.translation(), reach, [&](const TileId& id, const TilePoints& points) {
        if (points.sampling_level.empty() || !has_its_turn(id.key, frame)) return;
        const RigidMotion T_cam_tile = T_cam_local * map.submaps()[id.submap].T_local_submap *
                                       Eigen::Translation3d(points.origin);
        if (!ViewFrustum(camera, T_cam_tile).may_contain(points.box)) return;
        tiles.push_back({id, &points, {}});
      });
  std::vector<std::uint8_t> is_changed(tiles.size());
  parallel_for(tiles.size(), 1, [&](std::size_t k) {
    const std::vector<std::uint32_t> replaced = find_replaced(map, occupancy, tiles[k]);
    is_changed[k] = replaced.empty() ? 0 : 1;
    if (!replaced.empty()) tiles[k].kept = all_but(replaced, tiles[k].points->size());
  });
  const std::size_t before = map.size();
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    if (is_changed[k] == 0) continue;
    filter.follow_removal(tiles[k].id, tiles[k].kept);
    map.keep_points(tiles[k].id, tiles[k].kept);
  }
  return before - map.size();
}

}  // namespace fovea
