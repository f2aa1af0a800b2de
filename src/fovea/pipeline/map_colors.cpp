#include "fovea/pipeline/map_colors.h"

#include "fovea/base/parallel.h"
#include "fovea/base/random.h"
#include "fovea/mapping/color_fusion.h"
#include "fovea/mapping/depth_buffer.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 8192;
/// Radius of the disc that a point stands for over its footprint: discs of neighbours overlap.
constexpr float kDiscRadius = 0.75f;
/// Seed of the rounding of colours.
constexpr std::uint64_t kRounding = 0x636f6c6f7572ull;

/// A map point in the image.
struct SeenPoint {
  std::uint32_t index;  // in its tile
  Eigen::Vector2f pixel;
  float depth;
  float distance;
  bool in_region;
};

struct SeenTile {
  TileId id;
  const PointCloud* points;
  std::vector<SeenPoint> seen;
};

Eigen::Vector2f project(const Camera& camera, const Eigen::Vector3f& p_cam) {
  return {float(camera.fx) * p_cam.x() / p_cam.z() + float(camera.cx),
          float(camera.fy) * p_cam.y() / p_cam.z() + float(camera.cy)};
}

void look_at(SeenTile& tile, const TileMap& map, const MapView& view) {
  const Camera& camera = view.region.camera();
  const RigidMotion T_cam_submap = view.T_cam_local * map.submaps()[tile.id.submap].T_local_submap;
  const Eigen::Matrix3f R = T_cam_submap.linear().cast<float>();
  const Eigen::Vector3f t = (T_cam_submap * tile.points->origin).cast<float>();
  const auto right = static_cast<float>(camera.width - 1);
  const auto bottom = static_cast<float>(camera.height - 1);
  for (std::uint32_t i = 0; i < tile.points->size(); ++i) {
    const Eigen::Vector3f p = R * tile.points->position[i] + t;
    if (!(p.z() > float(Camera::kMinDepth))) continue;
    Eigen::Vector2f pixel = project(camera, p);
    if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= right && pixel.y() <= bottom)) continue;
    const bool in_region = view.region.contains(p, pixel);
    tile.seen.push_back({i, pixel, p.z(), p.norm(), in_region});
  }
}

float footprint_pixels(const MapView& view, float depth) {
  return static_cast<float>(view.footprint * view.region.camera().fx) / depth;
}

DepthBuffer front_of(const std::vector<SeenTile>& tiles, const PointCloud& new_points_cam,
                     const MapView& view) {
  DepthBuffer front(view.region.camera());
  const auto add = [&](const Eigen::Vector2f& pixel, float depth) {
    front.add(pixel, depth, kDiscRadius * footprint_pixels(view, depth));
  };
  for (const SeenTile& tile : tiles) {
    for (const SeenPoint& point : tile.seen) add(point.pixel, point.depth);
  }
  for (const Eigen::Vector3f& p : new_points_cam.position) {
    const Eigen::Vector2f pixel = project(view.region.camera(), p);
    if (view.region.camera().in_view(pixel.cast<double>())) add(pixel, p.z());
  }
  return front;
}

}  // namespace

void colour_new_points(PointCloud& points_cam, const MapView& view) {
  const Camera& camera = view.region.camera();
  const std::size_t n = points_cam.size();
  points_cam.frame.assign(n, view.frame);
  points_cam.camera.assign(n, static_cast<std::int8_t>(camera.index));
  points_cam.color.resize(n);
  points_cam.views.resize(n);
  points_cam.spread.resize(n);
  points_cam.weight.resize(n);
  parallel_for(n, kGrain, [&](std::size_t i) {
    const Eigen::Vector3f& p = points_cam.position[i];
    const Eigen::Vector2d pixel = project(camera, p).cast<double>();
    const Eigen::Vector3f seen = view.image.at(pixel.x(), pixel.y(), footprint_pixels(view, p.z()));
    const FusedColor first = fuse({}, seen, view_weight(p.norm()), 0);
    points_cam.color[i] = first.color;
    points_cam.views[i] = first.views;
    points_cam.spread[i] = first.spread;
    points_cam.weight[i] = first.weight;
  });
}

std::size_t recolour(TileMap& map, const MapView& view, const PointCloud& new_points_cam,
                     const Eigen::Vector3d& center_local) {
  std::vector<SeenTile> tiles;
  map.for_each_tile_near(center_local, view.region.far_range(),
                         [&](const TileId& id, const PointCloud& points) {
                           tiles.push_back({id, &points, {}});
                         });
  parallel_for(tiles.size(), 1, [&](std::size_t k) { look_at(tiles[k], map, view); });
  const DepthBuffer front = front_of(tiles, new_points_cam, view);

  const auto camera = static_cast<std::uint64_t>(view.region.camera().index);
  const std::uint64_t seed = static_cast<std::uint64_t>(view.frame) << 8 | camera;
  return parallel_sum(tiles.size(), 1, std::size_t{0}, [&](std::size_t k, std::size_t) {
    const TileColors colors = map.colors(tiles[k].id);
    std::size_t count = 0;
    for (const SeenPoint& point : tiles[k].seen) {
      if (!point.in_region || front.hides(point.pixel, point.depth)) continue;
      const std::uint32_t i = point.index;
      const Eigen::Vector3f seen =
          view.image.at(point.pixel.x(), point.pixel.y(), footprint_pixels(view, point.depth));
      const FusedColor fused =
          fuse({colors.color[i], colors.views[i], colors.spread[i], colors.weight[i]}, seen,
               view_weight(point.distance), Random::of_item(seed, kRounding, i).next());
      colors.color[i] = fused.color;
      colors.views[i] = fused.views;
      colors.spread[i] = fused.spread;
      colors.weight[i] = fused.weight;
      ++count;
    }
    return count;
  });
}

}  // namespace fovea
