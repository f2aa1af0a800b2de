// What a run of the mapper did, in figures.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/pipeline/self_calibration.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

struct StageLatency {
  double p50 = 0, p95 = 0, max = 0;  ///< ms
};

struct MapSummary {
  int frames_mapped = 0, frames_held_out = 0;
  std::map<std::string, int> frames_skipped;  ///< by reason
  std::map<int, int> images_missing;          ///< by camera; of frames that were not skipped
  int registrations_failed = 0;
  int loops_closed = 0;  ///< scans registered to a place seen before
  std::size_t points = 0;
  double frames_per_second = 0;  ///< mapped and held-out frames over the wall time of the run
  double rate = 0;  ///< Hz, at which frames were released; 0: as fast as they were mapped
  /// At a rate: frames whose points and colours were not yet in the map when the next one was due.
  int late_frames = 0;
  double peak_rss_mb = 0;
  std::map<std::string, StageLatency> latency_ms;
  bool interrupted = false;
  std::vector<std::string> notes;
  /// What the calibration lacks, a camera each; `calibrated`: what has been added to it.
  std::vector<CameraCalibration> calibration;
  bool calibrated = false;
  int skipped() const;
};

/// Counts frames, skips and failures of all records; latencies and late frames of those from
/// `first_new` on, which this run made at `rate` Hz or, with 0, without one. Points, rate and
/// interruption are the caller's to add.
MapSummary summarise(const std::vector<FrameRecord>& records, std::size_t first_new,
                     const DriveInfo& drive, double rate);

}  // namespace fovea
