#include <stdexcept>
#include <utility>

#include "fovea/api/drive_content.h"
#include "fovea/api/map_settings_of.h"
#include "fovea/api/mapped_frame.h"
#include "fovea/map/points_in_local.h"
#include "fovea/mapper.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/initial_motion.h"
#include "fovea/pipeline/make_mapper.h"

namespace fovea {

struct FrameMapper::Content {
  Content(const Drive& mapped_drive, const MapSettings& settings)
      : drive(mapped_drive), info(info_with_lidars(source())) {
    MapperServices services;
    services.initial_velocity = [this, compensate = settings.compensates_motion()](int frame) {
      return initial_velocity(source(), {}, frame, compensate);
    };
    mapper = make_mapper(info, settings, PoseSource::kRefine, std::move(services));
  }
  const FrameSource& source() const { return *drive.content()->source; }
  const TileMap& map() const { return std::as_const(*mapper).map(); }

  Drive drive;
  DriveInfo info;
  std::unique_ptr<IncrementalMapper> mapper;
  std::optional<int> last;  // frame
};

FrameMapper::FrameMapper(const Drive& drive, const MapperSettings& settings)
    : content_(std::make_unique<Content>(drive, map_settings_of(settings))) {}
FrameMapper::~FrameMapper() = default;
FrameMapper::FrameMapper(FrameMapper&&) noexcept = default;

MappedFrame FrameMapper::map(const DriveFrame& frame, bool held_out) {
  const Frame& read = frame_of(content_->drive, frame);
  if (content_->last && read.index <= *content_->last) {
    throw std::invalid_argument("frames are mapped in the drive's order, each once");
  }
  content_->last = read.index;
  return mapped_frame(record_of(content_->mapper->process(read, {.held_out = held_out})));
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
