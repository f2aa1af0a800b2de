// A run of a mapper over a drive, with its figures and its file.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fovea/drive/lost_drive.h"
#include "fovea/map/tile_cache.h"
#include "fovea/pipeline/calibration_check.h"
#include "fovea/pipeline/drive_log.h"
#include "fovea/pipeline/frame_pipeline.h"
#include "fovea/pipeline/keyframe_recorder.h"
#include "fovea/pipeline/live_clocks.h"
#include "fovea/pipeline/live_load.h"
#include "fovea/pipeline/live_state.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/pipeline/view_check.h"

namespace fovea {

/// Error if the run was stopped, for steps before there is a map to keep.
void require_no_stop(const MapJob& job);

///   MapRun run(source, drive, job, meta);
///   run.map_frames(stream, progress);
///   run.finish();
///
/// Over ten members: all state that lives as long as the run. The order counts: the mapper loads
/// tiles through the cache, the cache through the file.
class MapRun {
 public:
  /// @param source  of the drive
  /// @param drive   its description, with profiles of the LiDARs and corrections of the calibration
  /// @param meta    of the map
  /// All but `meta` must outlive the run. Errors as map_drive().
  MapRun(const FrameSource& source, const DriveInfo& drive, const MapJob& job, MapMeta meta)
      : MapRun(source, drive, job, std::move(meta), /*is_live=*/false) {}
  /// Of a drive that has further frames than the source, as it continues while it is mapped.
  static MapRun live(const FrameSource& first_frames, const DriveInfo& drive, const MapJob& job,
                     MapMeta meta) {
    return {first_frames, drive, job, std::move(meta), /*is_live=*/true};
  }
  /// Of a live drive: null if the calibration is not checked.
  LiveClocks* clocks() const { return clocks_.get(); }
  /// Origin of `local` in the world of a live drive's poses, for a later run.
  void keep_world_origin(const std::optional<Eigen::Vector3d>& origin) {
    live_state_.world_origin = origin;
  }

  /// The frames that are not in the map yet.
  std::vector<int> remaining_frames() const;
  /// Maps the frames, or those before the drive was lost.
  void map_frames(FrameStream& stream, const std::function<void(const RunProgress&)>& progress);
  /// Ends the file. InputError if no frame could be mapped.
  void finish();
  /// InputError if the drive was lost or too many of its frames are damaged. The file is complete
  /// as far as the frames go.
  void require_whole_drive() const;
  MapSummary summary() const;

 private:
  MapRun(const FrameSource& source, const DriveInfo& drive, const MapJob& job, MapMeta meta,
         bool is_live);
  CheckpointerOptions checkpointer_options();
  void resume_from_file();
  std::unique_ptr<IncrementalMapper> mapper_of_drive();
  TrackedScan track(const Frame& frame);  // runs in the tracker's thread
  /// Whether a frame is to add nothing to the map (FrameTask::skips_texture).
  bool skips_texture(const TrackedFrame& frame);
  void map_next(TrackedFrame& tracked, const std::function<void(const RunProgress&)>& progress);
  void account_for(const FrameRecord& record, bool is_new);
  void checkpoint_if_due();
  void check_calibration(const TrackedFrame& tracked, FrameRecord& record);
  void check_clocks(const TrackedFrame& tracked, FrameRecord& record);
  /// InputError if too many points were dropped so far.
  void check_points() const;
  MapRows fresh_rows(bool last);  // of a checkpoint
  /// Of a live drive: its identity so far, which is that of a drive of these frames.
  DriveRecord live_record() const;
  void resume_live(const MapReader& reader, const std::vector<FrameRecord>& records);
  void keep_target(TrackedScan& tracked);
  /// States the origin of navigation that begins after the first frames.
  void begin_navigation(const TrackedFrame& tracked);
  bool complete() const { return is_live_ || log_.size() == drive_.frame_count(); }

  const FrameSource& source_;
  const DriveInfo& drive_;
  const MapJob& job_;
  // Of the first checkpoint.
  MapMeta meta_;
  std::vector<DriveRecord> drive_records_;
  std::vector<SensorRecord> sensor_records_;
  bool is_live_;
  // Of a live drive.
  std::vector<std::optional<TimeNs>> live_stamps_;  // of all frames
  LiveState live_state_;
  std::optional<NavigationOrigin> navigation_origin_;  // of navigation that begins later
  std::unique_ptr<LiveClocks> clocks_;
  std::atomic<int> frames_read_ = 0;  // counted by the reader's thread
  LiveLoad load_;
  bool threaded_;
  Checkpointer file_;
  TileCache cache_;
  std::unique_ptr<IncrementalMapper> mapper_;
  DriveLog log_;
  KeyframeRecorder keyframes_;
  DriveFigures figures_;
  ViewCheck views_;
  std::optional<CalibrationCheck> check_;
  DriveCalibration calibration_;  // found by check_
  std::optional<FrameRecord> latest_;
  Eigen::Vector3d position_local_ = Eigen::Vector3d::Zero();  // of the last frame with a pose
  std::size_t frames_before_ = 0;                             // of an earlier run
  std::optional<DriveLostError> lost_;
};

}  // namespace fovea
