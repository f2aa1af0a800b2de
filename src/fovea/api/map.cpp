#include "fovea/map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/api/mapped_frame.h"
#include "fovea/errors.h"
#include "fovea/map/color_display.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/map_store.h"
#include "fovea/map/points_in_local.h"

namespace fovea {
namespace {

/// Whether a box may contain points of a tile.
bool is_near(const PointQuery::Box& box, const Eigen::Vector3d& center_local, double tile_size) {
  const double radius = tile_size * std::sqrt(3) / 2;
  const Eigen::Vector3d nearest = center_local.cwiseMax(box.low).cwiseMin(box.high);
  return (nearest - center_local).norm() <= radius;
}

/// The points of a tile that pass, in the frame `local`.
PointCloud passing_points(const PointCloud& tile, const RigidMotion& T_local_submap,
                          const PointQuery& query, const PointFilter& filter) {
  const auto is_inside = [&](const PointQuery::Box& box, std::size_t i) {
    const Eigen::Vector3d p = T_local_submap * (tile.origin + tile.position[i].cast<double>());
    return (p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all();
  };
  std::vector<std::uint32_t> passing;
  for (std::size_t i = 0; i < tile.size(); ++i) {
    if (query.box && !is_inside(*query.box, i)) continue;
    if (filter.matches(tile, i)) passing.push_back(static_cast<std::uint32_t>(i));
  }
  return points_in_local(tile.select(passing), T_local_submap);
}

void check(const PointQuery& query) {
  if (query.box && !(query.box->low.array() < query.box->high.array()).all()) {
    throw ConfigError("the box has no volume", "PointQuery::box", "give its low and high corner");
  }
}

}  // namespace

MappedFrame mapped_frame(const FrameRecord& record) {
  return {record.index, record.stamp,         record.status,
          record.note,  record.T_local_lidar, record.figures};
}

struct Map::Content {
  MapReader reader;
  ColorDisplay display;
};

Map::Map(const std::filesystem::path& file) {
  MapReader reader(file);
  const ColorDisplay display = color_display({}, reader.frames());
  content_ = std::make_unique<Content>(std::move(reader), display);
}
Map::~Map() = default;
Map::Map(Map&&) noexcept = default;

std::size_t Map::size() const { return content_->reader.size(); }
std::map<std::string, std::string> Map::meta() const { return content_->reader.meta(); }
std::string Map::digest() const { return content_->reader.digest(); }

std::vector<MappedFrame> Map::frames() const {
  std::vector<MappedFrame> frames;
  for (const FrameRecord& record : content_->reader.frames()) {
    frames.push_back(mapped_frame(record));
  }
  return frames;
}

PointCloud Map::points(const PointQuery& query) const {
  check(query);
  const PointFilter filter = query.where.empty() ? PointFilter() : PointFilter::parse(query.where);
  const MapReader& reader = content_->reader;
  const std::shared_ptr<const void> state = reader.hold_state();
  const double tile_size = map_tile_size(reader.meta());
  const std::vector<RigidMotion> T_local_submap = reader.submaps();
  PointCloud points_local;
  for (const auto& [id, count] : reader.tile_sizes()) {
    const Eigen::Vector3d middle(id.key.x + 0.5, id.key.y + 0.5, id.key.z + 0.5);
    const RigidMotion& T = T_local_submap.at(id.submap);
    if (query.box && !is_near(*query.box, T * (tile_size * middle), tile_size)) continue;
    const PointCloud found = passing_points(reader.read_tile(id), T, query, filter);
    if (!found.empty()) points_local.append(found);
  }
  return points_local;
}

std::vector<Rgb> Map::colors(const PointCloud& points) const {
  points.check();
  std::vector<Rgb> colors(points.size(), Rgb{128, 128, 128});
  if (points.color.empty() || points.camera.empty()) return colors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.camera[i] != kNoCamera) colors[i] = content_->display(points.color[i]);
  }
  return colors;
}

}  // namespace fovea
