// Private to api/.
#pragma once

#include "fovea/map.h"
#include "fovea/map/frame_record.h"

namespace fovea {

/// What the public API tells of a frame.
MappedFrame mapped_frame(const FrameRecord& record);

}  // namespace fovea
