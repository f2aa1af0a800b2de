#include "fovea/pipeline/map_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/base/parallel.h"
#include "fovea/base/random.h"
#include "fovea/mapping/color_fusion.h"
#include "fovea/pipeline/foveal_query.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 8192;
/// Radius of the disc that a point stands for over the points' spacing: discs of neighbours
/// overlap.
constexpr float kDiscRadius = 0.75f;
/// Seed of the rounding of colours.
constexpr std::uint64_t kRounding = 0x636f6c6f7572ull;

float pixels(double length, const Camera& camera, float depth) {
  return static_cast<float>(length * camera.fx) / depth;
}

Eigen::Vector3f color_at(const ColorView& view, const Eigen::Vector2f& pixel, float depth) {
  return view.gain *
         view.image.at(pixel.x(), pixel.y(), pixels(view.footprint, view.camera, depth)).array();
}

void put(const TileColors& colors, std::size_t i, const FusedColor& fused) {
  colors.color[i] = fused.color;
  colors.views[i] = fused.views;
  colors.spread[i] = fused.spread;
  colors.weight[i] = fused.weight;
}

/// Of the exposure: every how many points in view are asked, how many must tell at least, and which
/// grey values do (darker ones are noise, brighter ones saturated).
constexpr std::size_t kExposureStep = 16, kMinExposurePoints = 300;
constexpr float kDark = 12, kBright = 240;
/// Logarithm of the gain that is off, and the share of it that is undone.
constexpr float kOffGain = 0.34f, kUndone = 0.9f;

bool tells_exposure(const Eigen::Vector3f& color) {
  return color.minCoeff() > kDark && color.maxCoeff() < kBright;
}

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

bool is_exposure_off(const Eigen::Array3f& gain_to_map) {
  return std::abs(gain_to_map.log().mean()) > kOffGain;
}

Eigen::Array3f matching_gain(const Eigen::Array3f& gain_to_map) { return gain_to_map.pow(kUndone); }

void colour_new_points(PointCloud& points_cam, const ColorView& view) {
  const std::size_t n = points_cam.size();
  points_cam.frame.assign(n, view.frame);
  points_cam.camera.assign(n, static_cast<std::int8_t>(view.camera.index));
  points_cam.color.resize(n);
  points_cam.views.resize(n);
  points_cam.spread.resize(n);
  points_cam.weight.resize(n);
  if ((view.gain != 1).any()) {
    for (std::uint8_t& reason : points_cam.reason) reason |= kExposureMatched;
  }
  const TileColors colors{points_cam.color, points_cam.views, points_cam.spread, points_cam.weight};
  parallel_for(n, kGrain, [&](std::size_t i) {
    const Eigen::Vector3f& p = points_cam.position[i];
    const FusedColor first =
        fuse({}, color_at(view, pixel_of(view.camera, p), p.z()), view_weight(p.norm()), 0);
    put(colors, i, first);
  });
}

SeenMap::SeenMap(const TileMap& map, const FovealRegion& region, const RigidMotion& T_cam_local,
                 double spacing)
    : region_(region), spacing_(spacing), front_(region.camera()) {
  const Eigen::Vector3d lidar_local =
      T_cam_local.inverse() * region.camera().T_cam_lidar.translation();
  map.for_each_tile_near(lidar_local, region.far_range(),
                         [&](const TileId& id, const PointCloud& points) {
                           tiles_.push_back({id, &points, {}});
                         });
  parallel_for(tiles_.size(), 1, [&](std::size_t k) { look_at(map, T_cam_local, tiles_[k]); });
  for (const Tile& tile : tiles_) {
    for (const Point& point : tile.seen) put_in_front(point.pixel, point.depth);
  }
}

void SeenMap::look_at(const TileMap& map, const RigidMotion& T_cam_local, Tile& tile) const {
  const Camera& camera = region_.camera();
  const RigidMotion T_cam_submap = T_cam_local * map.submaps()[tile.id.submap].T_local_submap;
  const Eigen::Matrix3f R = T_cam_submap.linear().cast<float>();
  const Eigen::Vector3f t = (T_cam_submap * tile.points->origin).cast<float>();
  const auto right = static_cast<float>(camera.width - 1);
  const auto bottom = static_cast<float>(camera.height - 1);
  for (std::uint32_t i = 0; i < tile.points->size(); ++i) {
    const Eigen::Vector3f p = R * tile.points->position[i] + t;
    if (!(p.z() > float(Camera::kMinDepth))) continue;
    Eigen::Vector2f pixel = pixel_of(camera, p);
    if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= right && pixel.y() <= bottom)) continue;
    const bool in_region = region_.contains(p, pixel);
    tile.seen.push_back({i, pixel, p.z(), p.norm(), in_region});
  }
}

void SeenMap::put_in_front(const Eigen::Vector2f& pixel, float depth) {
  front_.add(pixel, depth, kDiscRadius * pixels(spacing_, region_.camera(), depth));
}

std::vector<std::uint8_t> SeenMap::marks_before(const PointCloud& points_cam) const {
  std::vector<std::uint8_t> marks(points_cam.size(), 0);
  const Camera& camera = region_.camera();
  parallel_for(marks.size(), kGrain, [&](std::size_t i) {
    const Eigen::Vector3f& p = points_cam.position[i];
    const Eigen::Vector2f pixel = pixel_of(camera, p);
    marks[i] = camera.in_view(pixel.cast<double>()) && front_.stands_before(pixel, p.z());
  });
  return marks;
}

Eigen::Array3f SeenMap::gain_to_map(const TileMap& map, const ColorView& view) const {
  std::array<std::vector<float>, 3> logs;
  for (const Tile& tile : tiles_) {
    const PointCloud& points = map.submaps()[tile.id.submap].tiles.at(tile.id.key);
    for (std::size_t k = 0; k < tile.seen.size(); k += kExposureStep) {
      const Point& point = tile.seen[k];
      if (!point.in_region || points.views[point.index] < 2) continue;
      if (front_.hides(point.pixel, point.depth)) continue;
      const Eigen::Vector3f known = to_float(points.color[point.index]);
      const Eigen::Vector3f seen = color_at(view, point.pixel, point.depth);
      if (!tells_exposure(known) || !tells_exposure(seen)) continue;
      for (int c = 0; c < 3; ++c) logs[std::size_t(c)].push_back(std::log(known[c] / seen[c]));
    }
  }
  if (logs[0].size() < kMinExposurePoints) return Eigen::Array3f::Ones();
  return Eigen::Array3f(median(logs[0]), median(logs[1]), median(logs[2])).exp();
}

std::size_t SeenMap::recolour(TileMap& map, const ColorView& view,
                              const PointCloud& new_points_cam) {
  for (const Eigen::Vector3f& p : new_points_cam.position) {
    const Eigen::Vector2f pixel = pixel_of(view.camera, p);
    if (view.camera.in_view(pixel.cast<double>())) put_in_front(pixel, p.z());
  }
  const auto camera = static_cast<std::uint64_t>(view.camera.index);
  const std::uint64_t seed = static_cast<std::uint64_t>(view.frame) << 8 | camera;
  return parallel_sum(tiles_.size(), 1, std::size_t{0}, [&](std::size_t k, std::size_t) {
    const TileColors colors = map.colors(tiles_[k].id);
    std::size_t count = 0;
    for (const Point& point : tiles_[k].seen) {
      if (!point.in_region || front_.hides(point.pixel, point.depth)) continue;
      const std::uint32_t i = point.index;
      const FusedColor fused =
          fuse({colors.color[i], colors.views[i], colors.spread[i], colors.weight[i]},
               color_at(view, point.pixel, point.depth), view_weight(point.distance),
               Random::of_item(seed, kRounding, i).next());
      put(colors, i, fused);
      ++count;
    }
    return count;
  });
}

}  // namespace fovea
