// A whole drive into a map file: reading, mapping, accounting, storing.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/drive/hold_out.h"
#include "fovea/map/checkpointer.h"
#include "fovea/map/frame_record.h"
#include "fovea/pipeline/incremental_mapper.h"
#include "fovea/pipeline/map_settings.h"
#include "fovea/pipeline/map_summary.h"

namespace fovea {

/// Observes a growing map. Called in the thread of map_drive().
class MapObserver {
 public:
  virtual ~MapObserver() = default;
  /// After each frame, in order.
  /// @param frame  nullptr if it was skipped
  virtual void frame_mapped(const FrameRecord& record, const Frame* frame, const TileMap& map) = 0;
  /// Before a checkpoint is written. All earlier checkpoints are in the file.
  virtual void map_changed(const TileChanges& changes, const MapRows& rows, const TileMap& map) = 0;
};

struct MapJob {
  std::filesystem::path output;
  MapSettings settings;
  std::string variant;  ///< name of the row that `settings` stands for, or empty
  HoldOut hold_out;
  PoseSource pose_source = PoseSource::kRefine;
  /// T_local_lidar of the frames of the drive's range, where pose_source is kGiven, or of its first
  /// ones (kGivenFirst).
  std::vector<RigidMotion> given_poses;
  /// Frames per second of a simulated live sensor; 0: full speed.
  double rate = 0;
  /// Reading, tracking, mapping and writing run in parallel if there is more than one thread. The
  /// map is the same.
  bool overlap = true;
  /// Of a live drive: no frame is left without texture if time is short (FrameTask).
  bool texture_every_frame = false;
  /// Called with the first frames of a live drive before they are mapped, to set the observer.
  std::function<void(const std::shared_ptr<const FrameSource>& first_frames)> on_begin;
  /// Called in the tracker's thread with each frame that has a pose; not of the paper's method.
  std::function<void(const FrameResult&)> on_tracked;
  bool calibrate = false;      ///< correct the calibration first (pipeline/drive_calibration.h)
  bool force = false;          ///< overwrite `output`
  bool allow_dropped = false;  ///< no limit for the share of dropped points
  bool resume = false;         ///< continue `output`, which an earlier run did not finish
  /// A folder in which the map grows (MapWriter::create); empty: it grows at `output`.
  /// The output is then a whole map or missing.
  std::filesystem::path scratch;
  /// Bytes that the process should keep to. Tiles out of reach are only in the file.
  std::size_t memory = std::size_t{1} << 30;
  /// Least number of frames from one checkpoint to the next. A crash costs these frames, and more
  /// on a slow disk.
  std::size_t checkpoint_frames = 30;
  MapObserver* observer = nullptr;  ///< or none; outlives the run
  std::stop_token stop;             ///< ends after the frames at hand; what was mapped is committed
};

struct RunProgress {
  int done = 0, total = 0;  ///< frames
  std::size_t points = 0;
  const FrameRecord* latest = nullptr;
};

/// Maps the frames of a drive into a map file. ARCHITECTURE.md draws its threads and queues.
/// @param progress  called in the caller's thread after each frame, in order
/// Errors as in MapWriter. InputError if no frame of the range is usable, if the drive has no poses
/// of navigation but the job needs them, or if the map to resume has other settings. InputError
/// after the map of all other frames is complete, if the drive was lost or too many frames are
/// damaged. After any other error, the file has the frames of the last commit and can be resumed.
MapSummary map_drive(const FrameSource& source, const MapJob& job,
                     const std::function<void(const RunProgress&)>& progress);

}  // namespace fovea
