#include "fovea/pipeline/map_run.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/drive/recalibrated_source.h"
#include "fovea/errors.h"
#include "fovea/map/camera_models.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/drive_records.h"
#include "fovea/pipeline/earlier_run.h"
#include "fovea/pipeline/initial_motion.h"
#include "fovea/pipeline/make_mapper.h"
#include "fovea/pipeline/map_tracked_frame.h"
#include "fovea/pipeline/run_preparation.h"

namespace fovea {
namespace {

/// Frames from one check of dropped points to the next: does not depend on timing.
constexpr std::size_t kPointsCheckedEvery = 30;

}  // namespace

void require_no_stop(const MapJob& job) {
  if (!job.stop.stop_requested()) return;
  throw Error("interrupted before the first frame was mapped", job.output.string(),
              "give the same command again");
}

MapRun::MapRun(const FrameSource& source, const DriveInfo& drive, const MapJob& job, MapMeta meta,
               bool is_live)
    : source_(source),
      drive_(drive),
      job_(job),
      meta_(std::move(meta)),
      drive_records_{drive_record(source)},
      sensor_records_(sensor_records(drive)),
      is_live_(is_live),
      threaded_(is_live || (job.overlap && available_threads() > 1)),
      file_(open_output(job), checkpointer_options()),
      cache_(file_, job.memory),
      mapper_(mapper_of_drive()),
      keyframes_(job.settings.run.range_image_spacing, drive),
      figures_(drive, job.rate),
      views_(drive) {
  if (job.settings.run.check_calibration && !job.calibrate) {
    if (is_live) {
      clocks_ = std::make_unique<LiveClocks>(drive, has_sweep_motion(drive, job));
    } else {
      check_.emplace(drive, has_sweep_motion(drive, job), /*is_live=*/false);
    }
  }
  store_camera_models(drive.calibration.cameras, /*drive=*/0, meta_);
  for (const Camera& camera : drive.calibration.cameras) {
    live_state_.image_delays[camera.index] = camera.image_delay;
  }
  if (job.resume) resume_from_file();
  frames_before_ = log_.size();
}

void MapRun::account_for(const FrameRecord& record, bool is_new) {
  figures_.add(record, is_new);
  if (is_live_) live_stamps_.push_back(record.stamp);
  if (check_) check_->add_pose(record);
  if (record.status != FrameStatus::kSkipped) {
    position_local_ = record.T_local_lidar.translation();
  }
}

void MapRun::check_points() const {
  if (job_.allow_dropped) return;
  require_few_dropped(figures_.points().dropped(), figures_.points().used(), drive_.path.string());
}

CheckpointerOptions MapRun::checkpointer_options() {
  CheckpointerOptions options{threaded_, job_.memory, /*commit_at_end=*/!job_.scratch.empty()};
  if (job_.observer != nullptr) {
    options.on_checkpoint = [this](const TileChanges& changes, const MapRows& rows) {
      job_.observer->map_changed(changes, rows, mapper_->map());
    };
  }
  return options;
}

std::unique_ptr<IncrementalMapper> MapRun::mapper_of_drive() {
  MapperServices services;
  services.initial_velocity = [this](int frame) {
    // By the corrected IMU.
    const RecalibratedSource corrected({std::shared_ptr<const FrameSource>{}, &source_}, drive_);
    return initial_velocity(corrected, job_.given_poses, frame, job_.settings.compensates_motion());
  };
  services.load_near = [this](TileMap& map, const Eigen::Vector3d& center_local, double radius) {
    cache_.load_within(map, center_local, radius);
  };
  return make_mapper(drive_, job_.settings, job_.pose_source, std::move(services));
}

void MapRun::resume_from_file() {
  const MapReader reader(job_.output);
  if (is_live_) {
    require_same_live_run(reader, meta_, drive_records_.front(), job_.output);
  } else {
    require_same_run(reader, meta_, drive_records_.front(), source_, job_.output);
  }
  keep_names(reader, meta_, drive_records_.front());
  const std::vector<FrameRecord> records = reader.stored_frames();
  for (const FrameRecord& record : records) {
    log_.add_stored(record);
    keyframes_.add_stored(record);
    account_for(record, /*is_new=*/false);
  }
  if (is_live_) {
    resume_live(reader, records);
  } else {
    mapper_->resume(stored_map(reader, job_.settings.tile_size()), records, source_);
  }
  if (!records.empty()) latest_ = records.back();
  if (log_.has_mapped()) views_.skip();
}

void MapRun::check_calibration(const TrackedFrame& tracked, FrameRecord& record) {
  if (!check_ || record.status != FrameStatus::kMapped) return;
  const Frame& frame = std::get<Frame>(tracked.read.result);
  if (!check_->is_due(frame.index)) return;
  const WallClock::time_point start = WallClock::now();
  if (const auto motion = mapped_motion(record, latest_)) check_->add_edges(frame, *motion);
  record.milliseconds["calibration"] = milliseconds_since(start);
}

MapRows MapRun::fresh_rows(bool last) {
  MapRows rows = log_.rows(mapper_->map(), /*exact=*/last);
  rows.keyframes = keyframes_.take();
  rows.meta = std::exchange(meta_, {});
  rows.drives = is_live_ ? std::vector{live_record()} : std::exchange(drive_records_, {});
  rows.sensors = std::exchange(sensor_records_, {});
  rows.meta[meta_key::kComplete] = fmt::to_string(last && complete() ? 1 : 0);
  if (!is_live_) return rows;
  const int end = rows.drives.front().end_frame;
  rows.meta[meta_key::kFramesEnd] = fmt::to_string(end);
  rows.states.emplace_back(kLiveState, checkpoint_of(live_state_, end - 1));
  return rows;
}

std::vector<int> MapRun::remaining_frames() const {
  std::vector<int> indices = drive_.frame_indices();
  indices.erase(indices.begin(), indices.begin() + std::ptrdiff_t(log_.size()));
  return indices;
}

void MapRun::map_frames(FrameStream& stream,
                        const std::function<void(const RunProgress&)>& progress) {
  const auto read = [&](const std::stop_token& stop) {
    std::optional<ReadFrame> frame = stream.next(stop);
    if (frame) ++frames_read_;
    return frame;
  };
  FramePipeline frames({.read = read,
                        .track = [&](const Frame& frame) { return track(frame); },
                        .apply_deferred = [&] { mapper_->apply_deferred_tracking(); }},
                       threaded_, job_.stop);
  try {
    while (std::optional<TrackedFrame> frame = frames.next()) {
      if (frame->tracked) frame->tracked->task.skips_texture = skips_texture(*frame);
      map_next(*frame, progress);
      checkpoint_if_due();
    }
  } catch (const DriveLostError& error) {
    lost_ = error;
  }
}

TrackedScan MapRun::track(const Frame& frame) {
  FrameTask task{.held_out = job_.hold_out.contains(frame.index)};
  const auto place = std::size_t(frame.index - drive_.begin);
  if (place < job_.given_poses.size()) task.given_pose = job_.given_poses[place];
  TrackedScan tracked = mapper_->track(frame, task);
  if (job_.on_tracked && !job_.settings.is_paper()) job_.on_tracked(tracked.result);
  return tracked;
}

void MapRun::map_next(TrackedFrame& tracked,
                      const std::function<void(const RunProgress&)>& progress) {
  const auto* frame = std::get_if<Frame>(&tracked.read.result);
  if (frame != nullptr) views_.add(frame->scan);
  keyframes_.add(tracked);
  if (is_live_ && tracked.tracked) keep_target(*tracked.tracked);
  if (is_live_) begin_navigation(tracked);
  FrameRecord record = map_tracked_frame(*mapper_, source_, drive_, tracked);
  check_calibration(tracked, record);
  check_clocks(tracked, record);
  account_for(record, /*is_new=*/true);
  log_.add(record);
  if (log_.size() % kPointsCheckedEvery == 0) check_points();
  if (job_.observer != nullptr) job_.observer->frame_mapped(record, frame, mapper_->map());
  if (progress) {
    const int total = is_live_ ? 0 : int(drive_.frame_count());
    progress({int(log_.size()), total, mapper_->map().size(), &record});
  }
  latest_ = std::move(record);
  mapper_->apply_deferred_mapping();
}

void MapRun::checkpoint_if_due() {
  if (!log_.has_mapped() || !views_.passed()) return;
  TileMap& map = mapper_->map();
  const bool is_due = log_.fresh() >= job_.checkpoint_frames && !file_.is_writing();
  if (!is_due && !cache_.is_full(map)) return;
  cache_.evict_beyond(map, position_local_, mapper_->reach());
  file_.checkpoint(map, fresh_rows(/*last=*/false));
}

void MapRun::finish() {
  if (!log_.has_mapped() || !views_.passed()) {
    require_no_stop(job_);
    if (lost_) throw DriveLostError(*lost_);
  }
  if (!log_.has_mapped()) {
    throw InputError("no frame could be mapped", latest_ ? latest_->note : drive_.path.string(),
                     "check that the drive has scans and images for the frames asked for");
  }
  views_.require_view();
  check_points();
  // While the writer thread writes the checkpoint before.
  if (check_) calibration_ = check_->estimate();
  if (clocks_) calibration_ = clocks_->first_calibration();
  if (!job_.scratch.empty()) require_whole_drive();
  file_.finish(mapper_->map(), fresh_rows(/*last=*/true));
}

void MapRun::require_whole_drive() const {
  if (lost_) {
    if (!job_.scratch.empty()) throw DriveLostError(*lost_);  // there is no map to resume
    throw InputError(lost_->problem(), lost_->where(),
                     fmt::format("{} and continue with --resume: {} holds the frames before",
                                 lost_->remedy(), job_.output.string()));
  }
  require_few_damaged(figures_.summary(), job_.settings.run.max_damaged_share, drive_.path.string(),
                      job_.output.string());
}

MapSummary MapRun::summary() const {
  MapSummary summary = figures_.summary();
  if (job_.pose_source == PoseSource::kGivenFirst) {
    summary.notes.push_back(
        fmt::format("{} poses for {} frames: the frames after them are registered",
                    job_.given_poses.size(), drive_.end - drive_.begin));
  }
  for (std::string& note : views_.notes()) summary.warn(std::move(note));
  if (clocks_) summary.append(clocks_->messages());
  warn_of_memory(summary, job_.memory);
  summary.points = mapper_->map().size();
  summary.frames_new = log_.size() - frames_before_;
  summary.interrupted = !complete();
  summary.calibration = calibration_;
  return summary;
}

}  // namespace fovea
