// Private to api/.
#pragma once

#include "fovea/map.h"
#include "fovea/map/frame_record.h"

namespace fovea {

/// A frame of a map for the public API.
MappedFrame mapped_frame(const FrameRecord& record);

}  // namespace fovea
