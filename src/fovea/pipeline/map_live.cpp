#include "fovea/pipeline/map_live.h"

#include <utility>

#include "fovea/errors.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/live_stream.h"
#include "fovea/pipeline/map_run.h"
#include "fovea/pipeline/run_meta.h"
#include "fovea/pipeline/run_preparation.h"

namespace fovea {
MapSummary map_live(LiveSource& source, const MapJob& job,
                    const std::function<void(const RunProgress&)>& progress) {
  const ClosedAtEnd closed(source);
  validate(job.settings);
  const std::shared_ptr<const FrameSource> first_frames = source.begin(job.stop);
  require_no_stop(job);
  if (!first_frames) {
    throw InputError("the live source ended before the first scan", job.output.string(),
                     "see docs/live.md for what a drive needs");
  }
  const WallClock::time_point start = WallClock::now();
  const DriveInfo drive = info_with_lidars(*first_frames);
  require_sources(drive, job);
  if (job.on_begin) job.on_begin(first_frames);
  MapRun run = MapRun::live(*first_frames, drive, job, meta_of_run(drive, job));
  run.keep_world_origin(source.world_origin());
  LiveStream frames(source, run.clocks());
  run.map_frames(frames, progress);
  run.finish();
  run.require_whole_drive();
  MapSummary summary = run.summary();
  summary.frames_per_second = double(summary.frames_new) / (milliseconds_since(start) / 1000);
  return summary;
}

}  // namespace fovea
