#include "fovea/map/point_files/point_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "fovea/errors.h"
#include "fovea/map/map_meta.h"

namespace fovea {
namespace {

constexpr std::size_t kBlockPoints = 65536;

}  // namespace

PointStream::PointStream(const MapReader& map, const PointChoice& choice)
    : map_(map),
      choice_(choice),
      held_state_(map.hold_state()),
      where_(map, choice.where),
      T_local_submap_(map.submaps()),
      georeference_(choice.crs, map_origin(map.meta()), "the map's table 'meta'"),
      display_(color_display(choice.exposure, map.frames())) {
  const std::size_t total = map_.size();
  const std::size_t unfiltered = choice_.include_uncolored ? total : map_.colored_size();
  figures_.points = choice_.where.empty() ? unfiltered : count_chosen();
  figures_.uncolored_left_out = total - unfiltered;
  figures_.filtered_out = unfiltered - figures_.points;
  if (choice_.deep_colors) {
    deep_display_ = deep_color_display(choice.exposure, map.frames(), count_codes());
  }
}

bool PointStream::is_chosen(std::size_t submap, const PointCloud& tile, std::size_t index) const {
  return (choice_.include_uncolored || tile.camera[index] != kNoCamera) &&
         where_.matches(submap, tile, index);
}

std::size_t PointStream::count_chosen() const {
  std::size_t count = 0;
  map_.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) count += is_chosen(submap, tile, i);
  });
  return count;
}

CodeCounts PointStream::count_codes() const {
  CodeCounts counts{};
  map_.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (!is_chosen(submap, tile, i) || tile.camera[i] == kNoCamera) continue;
      ++counts[*std::max_element(tile.color[i].code.begin(), tile.color[i].code.end())];
    }
  });
  return counts;
}

ExportPoint PointStream::point(const PointCloud& tile, std::size_t index,
                               std::size_t submap) const {
  ExportPoint point;
  point.position = georeference_.from_local(T_local_submap_.at(submap) *
                                            (tile.origin + tile.position[index].cast<double>()));
  if (!point.position.allFinite()) {
    throw InputError("the position of a point is not finite", "the map's tiles", kRestoreMap);
  }
  point.range = tile.range[index];
  point.incidence = tile.incidence[index];
  if (!tile.intensity.empty()) point.intensity = tile.intensity[index];
  point.sensor = tile.sensor_at(index);
  point.frame = tile.frame[index];
  point.camera = tile.camera[index];
  const bool is_colored = point.camera != kNoCamera;
  if (is_colored) point.color = display_(tile.color[index]);
  if (deep_display_) {
    const auto gray = static_cast<std::uint16_t>(257 * kUncolored.r);
    point.deep_color = is_colored ? (*deep_display_)(tile.color[index]) : DeepRgb{gray, gray, gray};
  }
  point.interpolated = tile.interpolated[index];
  point.views = tile.views[index];
  point.spread = tile.spread[index];
  point.reason = tile.reason[index];
  return point;
}

bool PointStream::has_intensity() const {
  std::optional<std::size_t> last_submap;
  for (const auto& [id, count] : map_.tile_sizes()) {
    if (count == 0 || id.submap == last_submap) continue;
    if (!map_.read_tile(id).intensity.empty()) return true;
    last_submap = id.submap;
  }
  return false;
}

void PointStream::for_each_block(const std::function<void(std::span<const ExportPoint>)>& f) const {
  std::size_t streamed = 0;
  std::vector<ExportPoint> block;
  const auto hand_over = [&] {
    if (!block.empty()) f(block);
    streamed += block.size();
    block.clear();
  };
  map_.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (!is_chosen(submap, tile, i)) continue;
      block.push_back(point(tile, i, submap));
      if (block.size() == kBlockPoints) hand_over();
    }
    hand_over();
  });
  require_all(streamed);
}

void PointStream::append_tile(const TileId& id, std::vector<ExportPoint>& points) const {
  PointCloud tile;
  if (held_state_ != nullptr) {
    tile = map_.read_tile(id);
  } else if (const std::optional<TilePoints> stored = map_.find_tile(id)) {
    tile = stored->cloud();
  }
  for (std::size_t i = 0; i < tile.size(); ++i) {
    if (is_chosen(id.submap, tile, i)) points.push_back(point(tile, i, id.submap));
  }
}

void PointStream::require_all(std::size_t streamed) const {
  if (streamed == figures_.points) return;
  throw InputError(
      fmt::format("the map holds {} points to export and says {}", streamed, figures_.points),
      "the map's tiles", "export it again when nothing writes to it, or map the drive again");
}

}  // namespace fovea
