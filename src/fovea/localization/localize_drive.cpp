#include "fovea/localization/localize_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "fovea/core/bounded_queue.h"
#include "fovea/core/errors.h"
#include "fovea/core/process_memory.h"
#include "fovea/core/thread.h"
#include "fovea/core/wall_clock.h"
#include "fovea/map/map_meta.h"
#include "fovea/pipeline/frame_reader.h"

namespace fovea {
namespace {

std::vector<int> wanted_frames(const DriveInfo& drive, const HoldOut& only) {
  std::vector<int> wanted;
  for (const int index : drive.frame_indices()) {
    if (only.none() || only.contains(index)) wanted.push_back(index);
  }
  return wanted;
}

}  // namespace

int LocalizedDrive::count(LocalizationState state) const {
  return static_cast<int>(std::count_if(frames.begin(), frames.end(),
                                        [&](const Localization& f) { return f.state == state; }));
}

int LocalizedDrive::found() const {
  return static_cast<int>(
      std::count_if(frames.begin(), frames.end(), [](const Localization& f) { return f.found; }));
}

LocalizedDrive localize_drive(const FrameSource& drive, std::unique_ptr<SurfaceSource> source,
                              const LocalizationJob& job,
                              const std::function<void(int, int)>& progress) {
  const std::vector<int> wanted = wanted_frames(drive.info(), job.only);
  Localizer localizer(std::move(source), drive.info(), job.guess, job.options);
  FrameReader frames(drive, wanted, /*rate=*/0);
  BoundedQueue<ReadFrame> read(/*capacity=*/1);
  const std::jthread reader = start_thread("fovea-read", [&](const std::stop_token& stop) {
    fill(read, stop, [&] { return frames.next(stop); });
  });
  LocalizedDrive localized;
  std::map<std::string, std::vector<float>> times;
  std::optional<SkippedFrame> skipped;
  const auto start = WallClock::now();
  while (const std::optional<ReadFrame> loaded = read.pop()) {
    if (const auto* frame = std::get_if<Frame>(&loaded->result)) {
      const auto began = WallClock::now();
      localized.frames.push_back(localizer.localize(*frame));
      const double took = milliseconds_since(began);
      times["decode"].push_back(float(loaded->decode_ms));
      times["localize"].push_back(float(took));
      times["frame"].push_back(float(loaded->decode_ms + took));
    } else {
      const SkippedFrame& unusable = std::get<SkippedFrame>(loaded->result);
      if (!skipped) skipped = unusable;
      Localization& none = localized.frames.emplace_back();
      none.index = unusable.index;
      none.stamp = drive.stamp(unusable.index);
    }
    progress(int(localized.frames.size()), int(wanted.size()));
  }
  const std::size_t scans = times["frame"].size();
  if (scans == 0) {
    throw InputError(skipped ? fmt::format("no frame has a scan (the first: {})", skipped->detail)
                             : "no frame was asked for",
                     drive.info().path.string(), "choose other frames");
  }
  if (skipped) {
    localized.warn(fmt::format("{} frames without a scan (the first: {})",
                               localized.count(LocalizationState::kSkipped), skipped->detail));
  }
  localized.frames_per_second = 1000 * double(scans) / milliseconds_since(start);
  localized.peak_rss_mb = double(peak_resident_memory()) / (1 << 20);
  for (auto& [stage, milliseconds] : times) {
    if (!milliseconds.empty()) localized.latency_ms[stage] = latency_of(std::move(milliseconds));
  }
  return localized;
}

std::optional<Trajectory> navigation_in_local(const DriveInfo& drive, const GeodeticPoint& origin) {
  if (!drive.navigation || !drive.origin) return std::nullopt;
  const RigidMotion T_local_drive = LocalTangentPlane(origin).T_local_enu(*drive.origin);
  std::vector<StampedPose> poses = drive.navigation->poses();
  for (StampedPose& pose : poses) pose.T_local_body = T_local_drive * pose.T_local_body;
  return Trajectory(std::move(poses));
}

std::optional<Trajectory> navigation_in_map(const DriveInfo& drive, const MapMeta& map) {
  const std::optional<GeodeticPoint> origin = map_origin(map);
  return origin ? navigation_in_local(drive, *origin) : std::nullopt;
}

}  // namespace fovea
