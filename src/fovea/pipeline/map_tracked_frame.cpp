#include "fovea/pipeline/map_tracked_frame.h"

#include <utility>

#include "fovea/core/wall_clock.h"
#include "fovea/pipeline/drive_records.h"
#include "fovea/pipeline/frame_result.h"

namespace fovea {

FrameRecord map_tracked_frame(IncrementalMapper& mapper, const FrameSource& source,
                              const DriveInfo& drive, TrackedFrame& tracked) {
  if (const auto* skipped = std::get_if<SkippedFrame>(&tracked.read.result)) {
    return skipped_record(*skipped, source.stamp(skipped->index));
  }
  const WallClock::time_point mapping_began = WallClock::now();
  const Frame& frame = std::get<Frame>(tracked.read.result);
  const FrameResult result = mapper.map_frame(frame, std::move(*tracked.tracked));
  FrameRecord record = record_of(result);
  record.milliseconds["frame"] = milliseconds_since(tracked.arrival());
  record.milliseconds["wait"] = milliseconds(tracked.tracking_began - tracked.arrival()) +
                                milliseconds(mapping_began - tracked.tracking_ended);
  record.milliseconds["decode"] = tracked.read.decode_ms;
  note_missing_parts(frame, record);
  add_views(frame, drive, result, record);
  return record;
}

}  // namespace fovea
