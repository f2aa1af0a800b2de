#include "fovea/pipeline/map_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/process_memory.h"
#include "fovea/errors.h"

namespace fovea {

StageLatency latency_of(std::vector<float> milliseconds) {
  std::sort(milliseconds.begin(), milliseconds.end());
  const auto at = [&](double share) -> double {
    return milliseconds[static_cast<std::size_t>(
        std::lround(share * double(milliseconds.size() - 1)))];
  };
  return {at(0.5), at(0.95), milliseconds.back()};
}

bool is_late(const FrameRecord& record, double rate) {
  const auto latency = record.milliseconds.find("frame");
  return rate > 0 && latency != record.milliseconds.end() && latency->second > 1000 / rate;
}

int MapSummary::skipped() const {
  int total = 0;
  for (const auto& [reason, count] : frames_skipped) total += count;
  return total;
}

void DriveFigures::Flaw::add(int index) {
  if (frames++ == 0) first = index;
}

std::string DriveFigures::Flaw::text(std::string_view description) const {
  return fmt::format("{} frame{} (the first: {}): {}", frames, frames == 1 ? "" : "s", first,
                     description);
}

void DriveFigures::note_flaws(const FrameRecord& record) {
  if (record.T_local_lidar_navigation && !record.has("registration_lost")) {
    navigation_.add(*record.T_local_lidar_navigation, record.T_odom_lidar);
  } else {
    navigation_.interrupt();
  }
  if (drive_.navigation && !record.T_local_lidar_navigation) absent_.add(record.index);
  if (record.has("navigation_jumped")) jumped_.add(record.index);
  if (record.has("imu_dropped"))
    imu_fault_ = fmt::format("frame {}: {}", record.index, record.note);
  if (record.has("registration_degenerate")) degenerate_.add(record.index);
  if (record.has("registration_lost")) lost_.add(record.index);
  if (record.has("pose_unknown")) {
    unknown_.add(record.index);
  } else if (record.has("track_restarted")) {
    restarted_.add(record.index);
  }
  if (record.has("images_blank")) blank_.add(record.index);
}

void DriveFigures::add(const FrameRecord& record, bool is_new) {
  switch (record.status) {
    case FrameStatus::kMapped:
      ++summary_.frames_mapped;
      break;
    case FrameStatus::kHeldOut:
      ++summary_.frames_held_out;
      break;
    case FrameStatus::kSkipped:
      ++summary_.frames_skipped[record.note.substr(0, record.note.find(':'))];
      if (record.has("damaged") && summary_.frames_damaged++ == 0) {
        summary_.first_damage = record.note;
      }
      break;
  }
  if (record.has("texture_skipped")) ++summary_.textures_skipped;
  if (record.has("registration_failed")) ++summary_.registrations_failed;
  points_.add(record);
  if (const auto missing = record.figures.find("scans_missing"); missing != record.figures.end()) {
    summary_.scans_missing += int(missing->second);
  }
  if (record.revisit) ++summary_.loops_closed;
  for (const Camera& camera : drive_.calibration.cameras) {
    if (!record.lacks_image(camera.index)) continue;
    ++summary_.images_missing[camera.index];
    if (record.status != FrameStatus::kSkipped) missing_[camera.index].add(record.index);
  }
  if (record.status != FrameStatus::kSkipped) note_flaws(record);
  if (!is_new) return;
  if (is_late(record, summary_.rate)) ++summary_.late_frames;
  for (const auto& [stage, ms] : record.milliseconds) {
    by_stage_[stage].push_back(static_cast<float>(ms));
  }
}

MapSummary DriveFigures::summary() const {
  MapSummary summary = summary_;
  for (const auto& [stage, times] : by_stage_) summary.latency_ms[stage] = latency_of(times);
  summary.points_dropped = points_.dropped();
  summary.points_read = points_.used() + points_.dropped().total();
  summary.append(drive_);
  if (points_.is_notable()) {
    summary.warn(points_.note());
  } else if (std::string note = points_.note(); !note.empty()) {
    summary.notes.push_back(std::move(note));
  }
  const auto note = [&](const Flaw& flaw, std::string_view description) {
    if (flaw.frames > 0) summary.notes.push_back(flaw.text(description));
  };
  const auto warn = [&](const Flaw& flaw, std::string_view description) {
    if (flaw.frames > 0) summary.warn(flaw.text(description));
  };
  warn(absent_, "no GPS/INS: the motion is from the scans alone");
  warn(jumped_, "GPS/INS moves otherwise than the scans, it counts for less from there on");
  if (!imu_fault_.empty()) summary.warn(imu_fault_);
  if (const auto cause = navigation_.likely_cause()) summary.warn(*cause);
  warn(lost_,
       "tracking is lost: the scan does not lie on the surfaces mapped before; poses from there on "
       "may be wrong");
  warn(restarted_,
       "the recording paused, and the scan shows no place of before; a new part of the map begins "
       "where navigation has it");
  warn(unknown_,
       "the recording paused, and neither navigation nor the scan relates the pose to those "
       "before; a new part of the map begins at the last pose, where it may overlap the others");
  note(degenerate_,
       "the scan leaves a direction of motion open, which is taken from the first guess");
  warn(blank_, "an image shows nothing but black or white and colors no point");
  for (const auto& [camera, flaw] : missing_) {
    warn(flaw, fmt::format("camera {} has no image that can be read, the frame is used without it",
                           camera));
  }
  for (const auto& [reason, count] : summary.frames_skipped) {
    summary.warn(fmt::format("skipped: {} frame{} ({})", count, count == 1 ? "" : "s", reason));
  }
  if (summary.textures_skipped > 0) {
    summary.warn(fmt::format("time was short: {} frame{} got a pose and added nothing to the map",
                             summary.textures_skipped, summary.textures_skipped == 1 ? "" : "s"));
  }
  if (summary.scans_missing > 0) {
    summary.warn(
        fmt::format("{} scan{} of further LiDARs are missing: these frames use the other LiDARs",
                    summary.scans_missing, summary.scans_missing == 1 ? "" : "s"));
  }
  if (summary.registrations_failed > 0) {
    summary.warn(fmt::format("registration failed on {} frames: their first guess was kept",
                             summary.registrations_failed));
  }
  summary.peak_rss_mb = double(peak_resident_memory()) / (1024 * 1024);
  return summary;
}

void require_few_damaged(const MapSummary& summary, double most, const std::string& drive,
                         const std::string& map) {
  const int damaged = summary.frames_damaged;
  const int usable = summary.frames_mapped + summary.frames_held_out;
  if (damaged <= most * (usable + damaged)) return;
  throw InputError(fmt::format("{} of {} frames are damaged (the first: {})", damaged,
                               usable + damaged, summary.first_damage),
                   drive,
                   fmt::format("restore them and map again, or allow a larger share (--set "
                               "input.max_damaged_share=1): {} holds the other frames",
                               map));
}

void warn_of_memory(MapSummary& summary, std::size_t limit) {
  const double limit_mb = double(limit) / (1024 * 1024);
  if (summary.peak_rss_mb <= limit_mb) return;
  summary.warn(
      fmt::format("the process took {:.0f} MB of memory at its peak, more than the {:.0f} "
                  "MB given: the map within reach of the cameras needs them",
                  summary.peak_rss_mb, limit_mb));
}

}  // namespace fovea
