#include "fovea/pipeline/map_drive.h"

#include <utility>

#include "fovea/pipeline/config.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/earlier_run.h"
#include "fovea/pipeline/frame_reader.h"
#include "fovea/pipeline/map_run.h"
#include "fovea/pipeline/run_meta.h"
#include "fovea/pipeline/run_preparation.h"

namespace fovea {

MapSummary map_drive(const FrameSource& source, const MapJob& job,
                     const std::function<void(const RunProgress&)>& progress) {
  const WallClock::time_point start = WallClock::now();
  validate(job.settings);
  DriveInfo drive = info_with_lidars(source);
  require_sources(drive, job);
  MapMeta meta = meta_of_run(drive, job);
  if (job.resume) {
    if (std::optional<MapSummary> complete = complete_run(source, drive, job, meta)) {
      return *std::move(complete);
    }
  }
  const DriveCalibration correction = correct_calibration(source, job, drive, meta);
  require_no_stop(job);
  MapRun run(source, drive, job, std::move(meta));
  FrameReader frames(source, run.remaining_frames(), job.rate);
  run.map_frames(frames, progress);
  run.finish();
  run.require_whole_drive();
  MapSummary summary = run.summary();
  if (job.calibrate) summary.calibration = correction;
  summary.calibrated = job.calibrate;
  summary.frames_per_second = double(summary.frames_new) / (milliseconds_since(start) / 1000);
  return summary;
}

}  // namespace fovea
