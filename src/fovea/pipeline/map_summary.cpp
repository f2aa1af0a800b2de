#include "fovea/pipeline/map_summary.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

StageLatency latency_of(std::vector<double> milliseconds) {
  std::sort(milliseconds.begin(), milliseconds.end());
  const auto at = [&](double share) {
    return milliseconds[static_cast<std::size_t>(
        std::lround(share * double(milliseconds.size() - 1)))];
  };
  return {at(0.5), at(0.95), milliseconds.back()};
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// A skipped frame has nothing to be late with.
bool is_late(const FrameRecord& record, double rate) {
  const auto latency = record.milliseconds.find("frame");
  return rate > 0 && latency != record.milliseconds.end() && latency->second > 1000 / rate;
}

/// Frames with a flaw of one kind.
struct Flaw {
  int frames = 0, first = 0;
  void add(int index) {
    if (frames++ == 0) first = index;
  }
  void note(const std::string& what, std::vector<std::string>& notes) const {
    if (frames > 0) {
      notes.push_back(fmt::format("{} frame{} (the first: {}): {}", frames, frames == 1 ? "" : "s",
                                  first, what));
    }
  }
};

/// What a user must know of poses and images.
void note_flaws(const std::vector<FrameRecord>& records, const DriveInfo& drive,
                std::vector<std::string>& notes) {
  Flaw absent, jumped, degenerate, blank, exposed;
  std::map<int, Flaw> missing;  // by camera
  for (const FrameRecord& record : records) {
    if (record.status == FrameStatus::kSkipped) continue;
    if (drive.navigation && !record.T_local_lidar_navigation) absent.add(record.index);
    if (record.has("navigation_jumped")) jumped.add(record.index);
    if (record.has("registration_degenerate")) degenerate.add(record.index);
    if (record.has("images_blank")) blank.add(record.index);
    if (record.has("exposure_off")) exposed.add(record.index);
    for (const Camera& camera : drive.calibration.cameras) {
      if (record.lacks_image(camera.index)) missing[camera.index].add(record.index);
    }
  }
  absent.note("no GPS/INS, the scans alone tell the motion", notes);
  jumped.note("GPS/INS moves otherwise than the scans, it counts for less from there on", notes);
  degenerate.note("the scan leaves a direction of motion open, which is taken from the first guess",
                  notes);
  exposed.note(
      "an image is exposed otherwise than the map by over 40 % and colours new points only", notes);
  blank.note("an image shows nothing but black or white and colours no point", notes);
  for (const auto& [camera, flaw] : missing) {
    flaw.note(fmt::format("camera {} has no image that can be read, the frame is used without it",
                          camera),
              notes);
  }
}

}  // namespace

int MapSummary::skipped() const {
  int total = 0;
  for (const auto& [reason, count] : frames_skipped) total += count;
  return total;
}

MapSummary summarise(const std::vector<FrameRecord>& records, std::size_t first_new,
                     const DriveInfo& drive, double rate) {
  MapSummary summary;
  summary.rate = rate;
  summary.notes = drive.notes;
  std::map<std::string, std::vector<double>> by_stage;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const FrameRecord& record = records[i];
    switch (record.status) {
      case FrameStatus::kMapped:
        ++summary.frames_mapped;
        break;
      case FrameStatus::kHeldOut:
        ++summary.frames_held_out;
        break;
      case FrameStatus::kSkipped:
        ++summary.frames_skipped[record.note.substr(0, record.note.find(':'))];
        break;
    }
    if (record.has("registration_failed")) ++summary.registrations_failed;
    if (record.revisit) ++summary.loops_closed;
    for (const Camera& camera : drive.calibration.cameras) {
      if (record.lacks_image(camera.index)) ++summary.images_missing[camera.index];
    }
    if (i < first_new) continue;
    if (is_late(record, rate)) ++summary.late_frames;
    for (const auto& [stage, ms] : record.milliseconds) by_stage[stage].push_back(ms);
  }
  for (auto& [stage, times] : by_stage) summary.latency_ms[stage] = latency_of(std::move(times));
  note_flaws(records, drive, summary.notes);
  summary.peak_rss_mb = peak_rss_mb();
  return summary;
}

}  // namespace fovea
