// The last stage of a frame: a tracked frame becomes part of the map.
#pragma once

#include "fovea/map/frame_record.h"
#include "fovea/pipeline/frame_pipeline.h"
#include "fovea/pipeline/incremental_mapper.h"

namespace fovea {

/// Maps a tracked frame, or reports a skipped one.
/// @return the frame's row in the map, with the times of all stages
FrameRecord map_tracked_frame(IncrementalMapper& mapper, const FrameSource& source,
                              const DriveInfo& drive, TrackedFrame& tracked);

}  // namespace fovea
