#include "fovea/map.h"

#include <utility>

#include "fovea/api/mapped_frame.h"
#include "fovea/map/color_display.h"
#include "fovea/map/map_store.h"
#include "fovea/map/point_query.h"

namespace fovea {

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

std::vector<MappedFrame> Map::frames() const { return mapped_frames(content_->reader.frames()); }

PointCloud Map::points(const PointQuery& query) const {
  return find_points(content_->reader, query);
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
