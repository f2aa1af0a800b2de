#include "fovea/pipeline/map_drive.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <future>

#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/base/path_name.h"
#include "fovea/base/version.h"
#include "fovea/map/map_keeper.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/drive_log.h"
#include "fovea/pipeline/drive_records.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/earlier_run.h"
#include "fovea/pipeline/frame_pipeline.h"
#include "fovea/pipeline/initial_motion.h"
#include "fovea/pipeline/self_calibration.h"
#include "fovea/pipeline/stored_calibration.h"
#include "fovea/pipeline/view_check.h"
#include "fovea/sensor/lost_drive.h"

namespace fovea {
namespace {

const char* to_string(PoseSource source) {
  switch (source) {
    case PoseSource::kRefine:
      return "refine";
    case PoseSource::kNavigation:
      return "navigation";
    case PoseSource::kGiven:
    case PoseSource::kGivenFirst:
      return "given";
  }
  return "unknown";
}

/// What the map says of itself; a run can only be resumed with the same.
MapMeta describe(const DriveInfo& drive, const MapJob& job) {
  MapMeta meta;
  meta[meta_key::kFoveaVersion] = version();
  meta[meta_key::kDriveName] = name_of(drive.path);
  meta[meta_key::kDriveKind] = drive.kind;
  std::vector<int> cameras;
  for (const Camera& camera : drive.calibration.cameras) cameras.push_back(camera.index);
  meta[meta_key::kCameras] = fmt::format("{}", fmt::join(cameras, ","));
  meta[meta_key::kFramesBegin] = fmt::format("{}", drive.begin);
  meta[meta_key::kFramesEnd] = fmt::format("{}", drive.end);
  meta[meta_key::kHoldOut] = job.hold_out.spec();
  meta[meta_key::kPoses] = to_string(job.pose_source);
  meta[meta_key::kVariant] = job.variant;
  meta[meta_key::kCalibration] = job.calibrate ? "corrected" : "as given";
  meta[meta_key::kConfig] = to_toml(job.options);
  meta[meta_key::kTileSize] = fmt::format("{}", job.options.tile_size);
  meta[meta_key::kGeoreferenced] = fmt::to_string(drive.origin ? 1 : 0);
  if (drive.origin) {
    meta[meta_key::kOriginLatitude] = fmt::format("{}", drive.origin->latitude);
    meta[meta_key::kOriginLongitude] = fmt::format("{}", drive.origin->longitude);
    meta[meta_key::kOriginHeight] = fmt::format("{}", drive.origin->altitude);
  }
  meta[meta_key::kNotes] = fmt::format("{}", fmt::join(drive.notes, "\n"));
  return meta;
}

bool is_damage(SkipReason reason) {
  return reason == SkipReason::kDamagedScan || reason == SkipReason::kDamagedImage;
}

FrameRecord skipped_record(const SkippedFrame& skipped, std::optional<TimeNs> stamp) {
  FrameRecord record;
  record.index = skipped.index;
  record.stamp = stamp;
  record.status = FrameStatus::kSkipped;
  record.note = fmt::format("{}: {}", to_string(skipped.reason), skipped.detail);
  if (is_damage(skipped.reason)) record.figures["damaged"] = 1;
  return record;
}

/// Counts and names the cameras that gave a frame no image.
void note_missing_images(const Frame& frame, FrameRecord& record) {
  for (const MissingImage& image : frame.missing_images) {
    record.count_missing_image(image.camera);
    record.note += fmt::format("{}camera {} gives nothing, {}: {}", record.note.empty() ? "" : "; ",
                               image.camera, to_string(image.reason), image.detail);
  }
}

/// The last stage of a frame.
FrameRecord map_frame(Mapper& mapper, const FrameSource& source, const DriveInfo& drive,
                      LocatedFrame& located) {
  if (const auto* skipped = std::get_if<SkippedFrame>(&located.result)) {
    return skipped_record(*skipped, source.stamp(skipped->index));
  }
  const WallClock::time_point mapping_began = WallClock::now();
  const Frame& frame = std::get<Frame>(located.result);
  FrameRecord record = mapper.add(frame, std::move(*located.tracked));
  record.milliseconds["frame"] = milliseconds_since(located.arrival);
  record.milliseconds["wait"] = milliseconds(located.tracking_began - located.arrival) +
                                milliseconds(mapping_began - located.tracking_ended);
  record.milliseconds["decode"] = located.decode_ms;
  note_missing_images(frame, record);
  add_views(frame, drive, record);
  return record;
}

/// Error if the run was stopped, for steps before there is a map to keep.
void require_no_stop(const MapJob& job) {
  if (!job.stop.stop_requested()) return;
  throw Error("interrupted before the first frame was mapped", job.output.string(),
              "give the same command again");
}

/// Whether anything states the motion that a calibration needs.
bool knows_motion(const DriveInfo& drive, const MapJob& job) {
  return drive.navigation.has_value() || !job.given_poses.empty();
}

bool has_sweep_motion(const DriveInfo& drive, const MapJob& job) {
  return job.options.compensate_motion && !drive.sweep_compensated;
}

std::vector<CameraCalibration> calibrate(const FrameSource& source, const MapJob& job) {
  CalibrationJob calibration;
  calibration.compensate = has_sweep_motion(source.info(), job);
  calibration.usable = [&](int index) { return !job.hold_out.contains(index); };
  calibration.motion = [&](int index) { return known_motion(source, job.given_poses, index); };
  calibration.stop = job.stop;
  return calibrate(source, calibration);
}

/// Where asked for, corrects the drive's calibration and puts the correction into the meta data.
std::vector<CameraCalibration> correct_calibration(const FrameSource& source, const MapJob& job,
                                                   DriveInfo& drive, MapMeta& meta) {
  if (!job.calibrate) return {};
  std::vector<CameraCalibration> correction = calibrate(source, job);
  drive.calibration = corrected(drive.calibration, correction);
  store_calibration(correction, meta);
  return correction;
}

/// A run of the mapper over a drive, with its accounts and its file.
class MapRun {
 public:
  MapRun(const FrameSource& source, const DriveInfo& drive, const MapJob& job, MapMeta meta)
      : source_(source),
        drive_(drive),
        job_(job),
        meta_(std::move(meta)),
        drive_records_{drive_record(source)},
        sensor_records_(sensor_records(drive)),
        threaded_(job.overlap && available_threads() > 1),
        keeper_(job.resume ? MapWriter::open(job.output) : MapWriter::create(job.output, job.force),
                keeper_options()),
        mapper_(drive, job.options, job.pose_source,
                [this](TileMap& map, const Eigen::Vector3d& center_local, double radius) {
                  keeper_.bring_near(map, center_local, radius);
                }),
        figures_(drive, job.rate),
        views_(drive) {
    const bool has_cameras = !drive.calibration.cameras.empty();
    if (has_cameras && job.options.check_calibration && !job.calibrate) {
      check_.emplace(drive, has_sweep_motion(drive, job));
    }
    begin_with_velocity_at(drive.begin);
    if (job.resume) take_up_earlier_run();
    frames_before_ = log_.size();
  }

  /// Maps all frames, or those before the drive was lost.
  void map_frames(const std::function<void(const MapProgress&)>& progress);
  /// Ends the file. InputError if no frame could be mapped.
  void finish();
  /// InputError if the drive was lost or too many of its frames are damaged. The file is complete
  /// as far as the frames go.
  void require_whole_drive() const;
  MapSummary summary() const;

 private:
  MapKeeperOptions keeper_options();
  void take_up_earlier_run();
  void begin_with_velocity_at(int index);
  void check_calibration(const LocatedFrame& located, FrameRecord& record);
  /// InputError if too many points were dropped so far.
  void check_points() const {
    if (job_.allow_dropped) return;
    require_few_dropped(figures_.points().dropped(), figures_.points().used(),
                        drive_.path.string());
  }
  MapRows fresh_rows(bool last);
  bool complete() const { return log_.size() == drive_.frame_count(); }

  const FrameSource& source_;
  const DriveInfo& drive_;
  const MapJob& job_;
  // Of the first checkpoint.
  MapMeta meta_;
  std::vector<DriveRecord> drive_records_;
  std::vector<SensorRecord> sensor_records_;
  bool threaded_;
  std::shared_ptr<IdleGate> gate_ = std::make_shared<IdleGate>();
  MapKeeper keeper_;
  Mapper mapper_;
  DriveLog log_;
  DriveFigures figures_;
  ViewCheck views_;
  std::optional<CalibrationCheck> check_;
  std::vector<CameraCalibration> calibration_;  // what it has found
  std::optional<FrameRecord> latest_;
  std::size_t frames_before_ = 0;  // of an earlier run
  std::optional<DriveLostError> lost_;
};

MapKeeperOptions MapRun::keeper_options() {
  MapKeeperOptions options{threaded_, job_.memory};
  if (threaded_ && job_.rate > 0) {
    options.pause = [gate = gate_](WallClock::time_point latest, const std::stop_token& hurry) {
      gate->wait(latest, hurry);
    };
  }
  if (job_.observer != nullptr) {
    options.on_checkpoint = [this](const TileChanges& changes, const MapRows& rows) {
      job_.observer->map_changed(changes, rows, mapper_.map());
    };
  }
  return options;
}

void MapRun::begin_with_velocity_at(int index) {
  mapper_.begin_with(
      initial_velocity(source_, job_.given_poses, index, job_.options.compensate_motion));
}

void MapRun::take_up_earlier_run() {
  const MapReader reader(job_.output);
  require_same_run(reader, meta_, drive_records_.front(), source_, job_.output);
  keep_names(reader, meta_, drive_records_.front());
  const std::vector<FrameRecord> records = reader.frames();
  for (const FrameRecord& record : records) {
    log_.add_stored(record);
    figures_.add(record, /*is_new=*/false);
  }
  mapper_.resume(stored_map(reader, job_.options.tile_size), records, source_);
  const auto tracked = std::find_if(records.rbegin(), records.rend(), [](const FrameRecord& r) {
    return r.status != FrameStatus::kSkipped;
  });
  if (tracked != records.rend() && mapper_.begins()) begin_with_velocity_at(tracked->index);
  if (!records.empty()) latest_ = records.back();
  if (log_.has_mapped()) views_.skip();
}

void MapRun::check_calibration(const LocatedFrame& located, FrameRecord& record) {
  if (!check_ || record.status != FrameStatus::kMapped) return;
  const Frame& frame = std::get<Frame>(located.result);
  if (!check_->is_due(frame.index)) return;
  const WallClock::time_point start = WallClock::now();
  if (const auto motion = mapped_motion(record, latest_)) check_->add(frame, *motion);
  record.milliseconds["calibration"] = milliseconds_since(start);
}

/// What a checkpoint writes besides tiles.
MapRows MapRun::fresh_rows(bool last) {
  MapRows rows = log_.rows(mapper_.map(), /*exact=*/last);
  rows.meta = std::exchange(meta_, {});
  rows.drives = std::exchange(drive_records_, {});
  rows.sensors = std::exchange(sensor_records_, {});
  rows.meta[meta_key::kComplete] = fmt::to_string(last && complete() ? 1 : 0);
  return rows;
}

void MapRun::map_frames(const std::function<void(const MapProgress&)>& progress) {
  const int total = static_cast<int>(drive_.frame_count());
  const auto track = [&](const Frame& frame) {
    std::optional<RigidMotion> given;
    const auto place = static_cast<std::size_t>(frame.index - drive_.begin);
    if (place < job_.given_poses.size()) given = job_.given_poses[place];
    if (mapper_.follows_pause(frame.stamp)) begin_with_velocity_at(frame.index);
    return mapper_.track(frame, job_.hold_out.contains(frame.index), given);
  };
  std::vector<int> indices = drive_.frame_indices();
  indices.erase(indices.begin(), indices.begin() + std::ptrdiff_t(log_.size()));
  FramePipeline frames(
      source_, std::move(indices), track,
      {job_.rate, threaded_, job_.stop, [this] { mapper_.settle_tracking(); }, gate_});
  const auto next_frame = [&]() -> std::optional<LocatedFrame> {
    try {
      return frames.next();
    } catch (const DriveLostError& error) {
      lost_ = error;
      return std::nullopt;
    }
  };
  while (std::optional<LocatedFrame> located = next_frame()) {
    if (const auto* frame = std::get_if<Frame>(&located->result)) views_.add(frame->scan);
    FrameRecord record = map_frame(mapper_, source_, drive_, *located);
    check_calibration(*located, record);
    figures_.add(record, /*is_new=*/true);
    log_.add(record);
    // Early, and at frames that do not depend on timing.
    constexpr std::size_t kCheckEvery = 30;
    if (log_.size() % kCheckEvery == 0) check_points();
    if (job_.observer != nullptr) {
      job_.observer->frame_mapped(record, std::get_if<Frame>(&located->result), mapper_.map());
    }
    if (progress) progress({static_cast<int>(log_.size()), total, mapper_.map().size(), &record});
    latest_ = std::move(record);
    mapper_.settle_map();
    const bool due = log_.fresh() >= job_.checkpoint_frames && !keeper_.is_writing();
    if (log_.has_mapped() && views_.passed() && (due || keeper_.needs_memory(mapper_.map()))) {
      keeper_.checkpoint(mapper_.map(), fresh_rows(/*last=*/false),
                         latest_->T_local_lidar.translation(), mapper_.reach());
    }
  }
}

void MapRun::finish() {
  if (!log_.has_mapped() || !views_.passed()) require_no_stop(job_);
  if (!log_.has_mapped()) {
    if (lost_) throw *lost_;
    throw InputError("no frame could be mapped", latest_ ? latest_->note : drive_.path.string(),
                     "check that the drive has scans and images for the frames asked for");
  }
  views_.require_view();
  check_points();
  // Beside the writer, which waits for the disk now and then.
  auto calibration = std::async(threaded_ ? std::launch::async : std::launch::deferred, [this] {
    return check_ ? check_->estimates() : std::vector<CameraCalibration>();
  });
  keeper_.finish(mapper_.map(), fresh_rows(/*last=*/true));
  calibration_ = calibration.get();
}

void MapRun::require_whole_drive() const {
  if (lost_) {
    throw InputError(lost_->problem(), lost_->where(),
                     lost_->remedy() + fmt::format(" and continue with --resume: {} holds the "
                                                   "frames before",
                                                   job_.output.string()));
  }
  const MapSummary& figures = figures_.summary();
  const int usable = figures.frames_mapped + figures.frames_held_out,
            damaged = figures.frames_damaged;
  if (damaged <= job_.options.max_damaged_share * (usable + damaged)) return;
  throw InputError(fmt::format("{} of {} frames are damaged (the first: {})", damaged,
                               usable + damaged, figures.first_damage),
                   drive_.path.string(),
                   fmt::format("restore them and map again, or allow a larger share (--set "
                               "input.max_damaged_share=1): {} holds the other frames",
                               job_.output.string()));
}

MapSummary MapRun::summary() const {
  MapSummary summary = figures_.summary();
  if (job_.pose_source == PoseSource::kGivenFirst) {
    summary.notes.push_back(
        fmt::format("{} poses for {} frames: the frames after them are registered",
                    job_.given_poses.size(), drive_.end - drive_.begin));
  }
  for (std::string& note : views_.notes()) summary.warn(std::move(note));
  const double limit_mb = double(job_.memory) / (1024 * 1024);
  if (summary.peak_rss_mb > limit_mb) {
    summary.warn(fmt::format(
        "{:.0f} MB of memory were needed at the peak, more than the {:.0f} MB given: what lies "
        "within the cameras' reach takes so much",
        summary.peak_rss_mb, limit_mb));
  }
  summary.points = mapper_.map().size();
  summary.frames_new = log_.size() - frames_before_;
  summary.interrupted = !complete();
  summary.calibration = calibration_;
  summary.can_calibrate = knows_motion(drive_, job_);
  return summary;
}

/// The summary of a map to resume that is complete; nothing if frames are missing.
std::optional<MapSummary> complete_run(const FrameSource& source, const DriveInfo& drive,
                                       const MapJob& job, const MapMeta& meta) {
  const MapReader reader(job.output);
  reader.check_structure();
  reader.check_records();
  // MapWriter refuses an older format.
  if (reader.format_version() != kMapFormatVersion || !is_complete(reader.meta())) return {};
  require_same_run(reader, meta, drive_record(source), source, job.output);
  DriveFigures figures(drive, job.rate);
  for (const FrameRecord& record : reader.frames()) figures.add(record, /*is_new=*/false);
  MapSummary summary = figures.summary();
  summary.points = reader.size();
  summary.notes.push_back("the map is complete: there is nothing to resume");
  return summary;
}

/// InputError if the drive lacks a motion or a camera that the job needs.
void require_sources(const DriveInfo& drive, const MapJob& job) {
  if (job.pose_source == PoseSource::kNavigation && !drive.navigation) {
    throw InputError("the drive has no navigation to take poses from", drive.path.string(),
                     "let registration find them (--poses refine)");
  }
  if (job.calibrate) require_cameras(drive, "calibration");
  if (job.options.refinement.visible_only) require_cameras(drive, "refinement.visible_only");
  if (job.calibrate && !knows_motion(drive, job)) {
    throw InputError("nothing says how the vehicle moves, which a calibration needs",
                     drive.path.string(), "give poses (--poses FILE) or map without --calibrate");
  }
}

}  // namespace

MapSummary map_drive(const FrameSource& source, const MapJob& job,
                     const std::function<void(const MapProgress&)>& progress) {
  const WallClock::time_point start = WallClock::now();
  DriveInfo drive = info_with_lidars(source);
  require_sources(drive, job);
  MapMeta meta = describe(drive, job);
  if (job.resume) {
    if (std::optional<MapSummary> complete = complete_run(source, drive, job, meta)) {
      return *std::move(complete);
    }
  }
  const std::vector<CameraCalibration> correction = correct_calibration(source, job, drive, meta);
  require_no_stop(job);
  MapRun run(source, drive, job, std::move(meta));
  run.map_frames(progress);
  run.finish();
  run.require_whole_drive();
  MapSummary summary = run.summary();
  if (job.calibrate) summary.calibration = correction;
  summary.calibrated = job.calibrate;
  summary.frames_per_second = double(summary.frames_new) / (milliseconds_since(start) / 1000);
  return summary;
}

}  // namespace fovea
