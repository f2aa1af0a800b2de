// Private to api/.
#pragma once

#include <vector>

#include "fovea/map.h"
#include "fovea/map/frame_record.h"

namespace fovea {

/// A frame of a map for the public API.
MappedFrame mapped_frame(const FrameRecord& record);
std::vector<MappedFrame> mapped_frames(const std::vector<FrameRecord>& records);

}  // namespace fovea
