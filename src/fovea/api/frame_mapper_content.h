// The contents of the public FrameMapper. Private to api/, and to the Python module.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fovea/api/drive_content.h"
#include "fovea/map/frame_record.h"
#include "fovea/mapper.h"
#include "fovea/pipeline/incremental_mapper.h"
#include "fovea/pipeline/map_settings.h"

namespace fovea {

struct FrameMapper::Content {
  Content(const Drive& mapped_drive, const MapSettings& settings);
  const FrameSource& source() const { return *drive.content()->source; }
  const TileMap& map() const { return std::as_const(*mapper).map(); }

  Drive drive;
  DriveInfo info;
  std::unique_ptr<IncrementalMapper> mapper;
  std::optional<int> last;           // frame
  std::vector<FrameRecord> records;  // of the frames so far
};

}  // namespace fovea
