// Figures of a run of the mapper.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/navigation/navigation_faults.h"
#include "fovea/map/frame_record.h"
#include "fovea/pipeline/calibration_check.h"
#include "fovea/pipeline/point_counts.h"

namespace fovea {

struct StageLatency {
  double p50 = 0, p95 = 0, max = 0;  ///< ms
};

/// Latency of measured times, at least one.
StageLatency latency_of(std::vector<float> milliseconds);

/// Whether a frame was not yet in the map when the next one was due. Skipped frames are never late.
/// @param rate  frames a second; 0: no frame is due
bool is_late(const FrameRecord& record, double rate);

struct MapSummary : Messages {
  int frames_mapped = 0, frames_held_out = 0;
  std::map<std::string, int> frames_skipped;  ///< by reason
  int frames_damaged = 0;                     ///< skipped frames with unusable files
  std::string first_damage;                   ///< one line: the fault and the file
  std::map<int, int> images_missing;          ///< by camera; of frames that were not skipped
  int scans_missing = 0;                      ///< of further LiDARs; their frames were not skipped
  int registrations_failed = 0;
  int loops_closed = 0;  ///< scans registered to an earlier place
  std::size_t points = 0;
  std::size_t points_read = 0;   ///< of the scans, including dropped ones
  DroppedPoints points_dropped;  ///< of these
  std::size_t frames_new =
      0;  ///< of all kinds, by this run and not by an earlier one that it resumes
  double frames_per_second = 0;  ///< mapped and held-out frames over the wall time of the run
  double rate = 0;               ///< Hz, of the released frames; 0: as fast as possible
  /// At a rate: frames that were not yet in the map when the next one was due.
  int late_frames = 0;
  int textures_skipped = 0;  ///< frames that only got a pose (FrameTask::skips_texture)
  double peak_rss_mb = 0;
  std::map<std::string, StageLatency> latency_ms;
  bool interrupted = false;
  DriveCalibration calibration;  ///< estimated corrections; applied if `calibrated`
  bool calibrated = false;
  int skipped() const;
};

/// InputError if more than a share of the frames is damaged.
/// @param drive, map  where the error is, and the file that holds the other frames
void require_few_damaged(const MapSummary& summary, double most, const std::string& drive,
                         const std::string& map);

/// Accumulates a summary frame by frame.
class DriveFigures {
 public:
  /// @param drive  must outlive the figures
  /// @param rate   Hz, of the frames that this run releases, or 0
  DriveFigures(const DriveInfo& drive, double rate) : drive_(drive), navigation_(drive) {
    summary_.rate = rate;
  }

  /// Counts a frame with its failures.
  /// @param is_new  by this run, not an earlier one: latencies and lateness count, too
  void add(const FrameRecord& record, bool is_new);

  const PointCounts& points() const { return points_; }

  /// The caller adds points, rate of frames, calibration and interruption.
  MapSummary summary() const;

 private:
  /// Frames with one kind of flaw.
  struct Flaw {
    int frames = 0, first = 0;
    void add(int index);
    /// "3 frames (the first: 7): WHAT".
    std::string text(std::string_view description) const;
  };
  void note_flaws(const FrameRecord& record);

  const DriveInfo& drive_;
  NavigationFaults navigation_;
  MapSummary summary_;
  std::map<std::string, std::vector<float>> by_stage_;  // ms
  Flaw absent_, jumped_, degenerate_, lost_, restarted_, unknown_, blank_;
  std::map<int, Flaw> missing_;  // by camera
  std::string imu_fault_;
  PointCounts points_;
};

/// Warns if the process took more than `limit` bytes of memory.
void warn_of_memory(MapSummary& summary, std::size_t limit);

}  // namespace fovea
