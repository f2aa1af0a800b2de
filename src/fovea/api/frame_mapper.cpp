#include <stdexcept>
#include <utility>

#include "fovea/api/frame_mapper_content.h"
#include "fovea/api/map_settings_of.h"
#include "fovea/api/mapped_frame.h"
#include "fovea/map/points_in_local.h"
#include "fovea/pipeline/drive_records.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/initial_motion.h"
#include "fovea/pipeline/make_mapper.h"

namespace fovea {

FrameMapper::Content::Content(const Drive& mapped_drive, const MapSettings& settings)
    : drive(mapped_drive), info(info_with_lidars(source())) {
  MapperServices services;
  services.initial_velocity = [this, compensate = settings.compensates_motion()](int frame) {
    return initial_velocity(source(), {}, frame, compensate);
  };
  mapper = make_mapper(info, settings, PoseSource::kRefine, std::move(services));
}

FrameMapper::FrameMapper(const Drive& drive, const MapperSettings& settings)
    : content_(std::make_unique<Content>(drive, map_settings_of(settings))) {}
FrameMapper::~FrameMapper() = default;
FrameMapper::FrameMapper(FrameMapper&&) noexcept = default;

MappedFrame FrameMapper::map(const DriveFrame& frame, bool held_out) {
  Content& content = *content_;
  const Frame& read = frame_of(content.drive, frame);
  if (content.last && read.index <= *content.last) {
    throw std::invalid_argument("frames are mapped in the drive's order, each once");
  }
  content.last = read.index;
  const FrameResult result = content.mapper->process(read, {.held_out = held_out});
  FrameRecord& record = content.records.emplace_back(record_of(result));
  add_views(read, content.info, result, record);
  return mapped_frame(record);
}

std::size_t FrameMapper::size() const { return content_->map().size(); }

PointCloud FrameMapper::points() const {
  PointCloud points_local;
  for (const Submap& submap : content_->map().submaps()) {
    for (const auto& [key, tile] : submap.tiles) {
      const PointCloud points = points_in_local(tile.points->cloud(), submap.T_local_submap);
      if (!points.empty()) points_local.append(points);
    }
  }
  return points_local;
}

}  // namespace fovea
