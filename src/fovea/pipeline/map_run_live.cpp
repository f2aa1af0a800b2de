// What a run of a live drive does otherwise than that of a drive from files.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "fovea/errors.h"
#include "fovea/map/drive_fingerprint.h"
#include "fovea/mapping/registration/local_map.h"
#include "fovea/pipeline/drive_records.h"
#include "fovea/pipeline/earlier_run.h"
#include "fovea/pipeline/map_run.h"
#include "fovea/pipeline/run_meta.h"

namespace fovea {

void MapRun::resume_live(const MapReader& reader, const std::vector<FrameRecord>& records) {
  const std::optional<TimeNs> first = source_.stamp(drive_.begin);
  const auto last = std::find_if(records.rbegin(), records.rend(), [](const FrameRecord& record) {
    return record.stamp.has_value();
  });
  if (first && last != records.rend() && *first <= *last->stamp) {
    throw InputError(fmt::format("the first scan is {:.1f} s before the last one of the map",
                                 seconds(*last->stamp - *first)),
                     job_.output.string(), "set the clock of the robot, or start a new map");
  }
  const LiveState earlier = live_state(reader).value_or(LiveState());
  live_state_.targets = earlier.targets;
  const EarlierScans scans(reader, earlier);
  mapper_->resume_live(stored_map(reader, job_.settings.tile_size()), records,
                       [&](int frame) { return scans.find(frame); });
}

void MapRun::keep_target(TrackedScan& tracked) {
  // As many as the local map depends on.
  const auto kept = std::size_t(LocalMap::memory(LocalMapOptions{}));
  if (tracked.target_lidar.empty()) return;
  live_state_.targets.push_back({tracked.result.index, std::move(tracked.target_lidar)});
  if (live_state_.targets.size() > kept) live_state_.targets.pop_front();
}

void MapRun::begin_navigation(const TrackedFrame& tracked) {
  const auto* frame = std::get_if<Frame>(&tracked.read.result);
  if (frame != nullptr && frame->motion.begins) navigation_origin_ = frame->motion.begins;
  const bool begins = tracked.tracked && tracked.tracked->result.tracking.has_navigation_begun;
  if (!begins || !navigation_origin_) return;
  live_state_.world_origin = navigation_origin_->world;
  if (!navigation_origin_->point) return;
  set_origin(navigation_origin_->point, meta_);
  set_origin(*navigation_origin_->point, navigation_origin_->coordinates, drive_records_.front());
}

void MapRun::check_clocks(const TrackedFrame& tracked, FrameRecord& record) {
  const auto* frame = std::get_if<Frame>(&tracked.read.result);
  if (!clocks_ || frame == nullptr) return;
  const WallClock::time_point start = WallClock::now();
  std::optional<FrameMotion> motion;
  if (record.status == FrameStatus::kMapped) motion = mapped_motion(record, latest_);
  clocks_->add(*frame, record, motion);
  record.milliseconds["calibration"] = milliseconds_since(start);
}

DriveRecord MapRun::live_record() const {
  DriveRecord record = drive_records_.front();
  record.end_frame = record.first_frame + int(live_stamps_.size());
  record.stamps_fingerprint = stamps_fingerprint(record.first_frame, live_stamps_);
  return record;
}

bool MapRun::skips_texture(const TrackedFrame& frame) {
  if (!is_live_ || job_.texture_every_frame || job_.settings.is_paper()) return false;
  // The first frames come all at once.
  const int later = std::max(frame.tracked->result.index + 1, drive_.end);
  return load_.skips_next(drive_.begin + frames_read_ - later,
                          milliseconds_since(frame.arrival()) / 1000);
}

}  // namespace fovea
