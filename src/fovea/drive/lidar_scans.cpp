#include "fovea/drive/lidar_scans.h"

#include <fmt/format.h>

#include <utility>

#include "fovea/drive/drive_stamps.h"
#include "fovea/drive/scans/described_sweep.h"
#include "fovea/drive/scans/recognized_format.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

NumberedTimes times_of(const TimeStamps& stamps) {
  NumberedTimes times;
  for (std::size_t i = 0; i < stamps.times.size(); ++i) {
    if (stamps.times[i]) times.emplace(int(i), *stamps.times[i]);
  }
  return times;
}

}  // namespace

NumberedFiles list_scans(const fs::path& drive, const LidarDescription& lidar) {
  NumberedFiles scans = list_numbered_files(drive / lidar.folder, {".bin", ".pcd", ".ply"});
  if (!scans.empty() && scans.rbegin()->first >= kMaxFileNumber) {
    throw InputError(fmt::format("a scan's number is over {}", kMaxFileNumber - 1),
                     scans.rbegin()->second.string(), "number the scans from 0 on");
  }
  return scans;
}

TimeStamps read_stamps_of_scans(const fs::path& table, const NumberedFiles& scans,
                                Messages& messages) {
  TimeStamps stamps;
  if (!fs::exists(table)) return stamps;
  stamps.times.resize(static_cast<std::size_t>(scans.rbegin()->first) + 1);
  for (const auto& [scan, time] : read_scan_stamps(table, messages)) {
    if (scans.contains(scan)) stamps.times[static_cast<std::size_t>(scan)] = time;
  }
  remove_out_of_order(stamps);
  if (const std::size_t count = stamps.out_of_order.size(); stamps.any() && count > 0) {
    messages.warn(
        fmt::format("{} stamps of {} are out of order (the first of scan {}): "
                    "these scans are skipped",
                    count, table.string(), stamps.out_of_order.front()));
  }
  return stamps;
}

ScanReading recognize_scans(const fs::path& drive, const LidarDescription& lidar,
                            const NumberedFiles& scans, const StampOfScan& stamp,
                            std::optional<double> stamp_step, Messages& messages) {
  return recognize_scans(
      drive / "drive.toml", lidar,
      {read_first_numbers(scans, kFirstScans, stamp),
       [&](const ScanFormat& format) { return first_sweep_middle(scans, format, stamp); }},
      stamp_step, messages);
}

ScanReading recognize_scans(const fs::path& toml, const LidarDescription& lidar,
                            const FirstScans& first, std::optional<double> stamp_step,
                            Messages& messages) {
  StatedScanFormat stated = lidar.scan_format;
  if (lidar.sweep_compensated) stated.time_reference = TimeReference::kNone;
  ScanReading reading;
  reading.format =
      recognize_format_of_drive(first.numbers, stated, toml, lidar.table(), messages.notes);
  const SweepDescription& sweep = lidar.sweep;
  reading.sweep = sweep_timing(sweep, stamp_step);
  if (lidar.sweep_compensated) return reading;
  const auto middle = first.middle(reading.format);
  reading.has_times = middle.has_value();
  reading.sweep_middle = middle.value_or(reading.sweep.middle_time());
  if (first.numbers.empty() || middle) return reading;
  std::string note = assumed_sweep_note(reading.sweep, lidar, stamp_step);
  const bool all_stated =
      sweep.period && sweep.direction && sweep.start_azimuth && sweep.stamp_phase;
  if (all_stated) {
    messages.notes.push_back(std::move(note));
  } else {
    messages.warn(std::move(note));
  }
  return reading;
}

FurtherLidar find_further_lidar(const fs::path& drive, const LidarDescription& lidar,
                                const std::vector<int>& frame_numbers, const NumberedTimes& frames,
                                double sweep_middle, Messages& messages) {
  FurtherLidar further;
  further.name = lidar.name;
  further.T_lidar_sensor = lidar.T_lidar_sensor;
  further.sweep_compensated = lidar.sweep_compensated;
  const NumberedFiles scans = list_scans(drive, lidar);
  const fs::path folder = drive / lidar.folder;
  if (scans.empty()) {
    throw InputError(fmt::format("LiDAR {} has no scan", lidar.name), folder.string(),
                     fmt::format("put its scans there, or remove [{}]", lidar.table()));
  }
  const TimeStamps stamps = read_stamps_of_scans(folder / "stamps.csv", scans, messages);
  const bool has_stamps = stamps.any() && !frames.empty();
  const NumberedTimes times = has_stamps ? times_of(stamps) : frames;
  const StampOfScan stamp = [&](int scan) -> std::optional<TimeNs> {
    const auto time = times.find(scan);
    if (time != times.end()) return time->second;
    return frames.empty() ? std::optional<TimeNs>(0) : std::nullopt;
  };
  std::optional<double> step = median_period(stamps);
  if (step && !can_be_sweep_period(*step)) step.reset();
  const ScanReading reading = recognize_scans(drive, lidar, scans, stamp, step, messages);
  further.format = reading.format;
  further.sweep = reading.sweep;
  further.has_times = reading.has_times;
  if (has_stamps) {
    for (const auto& [frame, scan] : match_scans(frames, times, sweep_middle - reading.sweep_middle,
                                                 reading.sweep.period / 2)) {
      further.scans[frame] = scans.at(scan);
      further.stamps[frame] = times.at(scan);
    }
  } else {
    if (stamps.any()) {
      messages.warn((folder / "stamps.csv").string() + " is not used: the frames have no stamps");
    }
    for (const int frame : frame_numbers) {
      const auto scan = scans.find(frame);
      if (scan != scans.end()) further.scans.insert(*scan);
    }
  }
  const char* const rule = has_stamps ? "within half a sweep" : "of the number";
  if (further.scans.empty()) {
    throw InputError(
        fmt::format("no scan of LiDAR {} is {} of a frame", lidar.name, rule), folder.string(),
        fmt::format("give stamps of one clock (stamps.csv), or remove [{}]", lidar.table()));
  }
  const std::size_t all = frame_numbers.size();
  if (further.scans.size() < all) {
    messages.warn(fmt::format("LiDAR {} has no scan {} of {} of {} frames", lidar.name, rule,
                              all - further.scans.size(), all));
  }
  return further;
}

}  // namespace fovea
