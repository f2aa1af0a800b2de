// VisibleMap::differences(): colors of a view against those of the map.
#include <algorithm>
#include <array>

#include "fovea/core/parallel.h"
#include "fovea/pipeline/visible_map.h"

namespace fovea {
namespace {

constexpr std::size_t kBlock = ColorBlock::kSize;
/// About this many points are compared, at even steps of at most kLargestStep.
constexpr std::size_t kCompared = 12'000, kLargestStep = 64;

}  // namespace

float VisibleMap::height_of(const Eigen::Vector2f& pixel, float depth) const {
  const Eigen::Vector3d p_cam((double(pixel.x()) - camera_.cx) / camera_.fx * double(depth),
                              (double(pixel.y()) - camera_.cy) / camera_.fy * double(depth),
                              double(depth));
  const RigidMotion& T_cam_lidar = camera_.T_cam_lidar;
  return static_cast<float>(T_cam_lidar.linear().col(2).dot(p_cam - T_cam_lidar.translation()));
}

MapDifferences VisibleMap::differences_of(const Chunk& chunk, std::size_t step,
                                          const ViewColors& view, double below) const {
  const std::span<const PointInView> points = points_of(chunk);
  const double offset = view.response().offset;
  MapDifferences differences;
  ProjectedPoints projected;
  std::array<Eigen::Array3f, kBlock> known;
  std::size_t n = 0;
  const auto compare_block = [&] {
    ViewColors::Samples seen;
    view.sample(projected, n, seen);
    for (std::size_t i = 0; i < n; ++i) {
      if (seen[i].weight == 0 || seen[i].saturated != 0) continue;
      if (seen[i].code.minCoeff() < float(color_code(kDarkValue))) continue;
      const Eigen::Array3f in_map = exposure_codes(known[i], offset);
      differences.recent.add(exposure_codes(seen[i].code, offset) - in_map);
      differences.colors.add(in_map);
      const Eigen::Vector2f pixel(projected.u[i], projected.v[i]);
      if (height_of(pixel, projected.depth[i]) < -float(below)) differences.ground.add(in_map);
    }
    n = 0;
  };
  for (std::size_t i = 0; i < points.size(); i += step) {
    const FusedColor& color = chunk.points->colors[chunk.begin + points[i].index];
    if (color.views == 0 || color.saturated != 0) continue;
    const Eigen::Vector2f pixel = quantizer_.pixel(points[i]);
    const float depth = quantizer_.depth(points[i]);
    if (depth_.hides(pixel, depth)) continue;
    known[n] = codes_of(color.color) + chunk.gain_codes;
    projected.put(n++, pixel, depth);
    if (n == kBlock) compare_block();
  }
  compare_block();
  return differences;
}

MapDifferences VisibleMap::differences(const ViewColors& view, double below) const {
  std::size_t in_region = 0;
  for (const Chunk& chunk : chunks_) in_region += chunk.count;
  const std::size_t step = std::clamp<std::size_t>(in_region / kCompared, 1, kLargestStep);
  std::vector<MapDifferences> of_chunk(chunks_.size());
  parallel_for(chunks_.size(), 1,
               [&](std::size_t k) { of_chunk[k] = differences_of(chunks_[k], step, view, below); });
  MapDifferences all;
  for (std::size_t k = 0; k < chunks_.size(); ++k) {
    const std::size_t submap = chunks_[k].tile.submap;
    if (submap < first_recent_submap_) {
      all.earlier[submap].append(of_chunk[k].recent);
    } else {
      all.recent.append(of_chunk[k].recent);
      all.colors.append(of_chunk[k].colors);
      all.ground.append(of_chunk[k].ground);
    }
  }
  return all;
}

}  // namespace fovea
