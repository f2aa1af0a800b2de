#include "fovea/pipeline/drive_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "fovea/core/path_name.h"
#include "fovea/map/drive_fingerprint.h"

namespace fovea {
namespace {

/// 2000-01-01 in Unix time. Earlier stamps have another epoch.
constexpr TimeNs kEarliestDate = 946'684'800 * kNsPerSecond;

/// The day of a stamp; empty if it is not in Unix time.
std::optional<std::string> utc_day(std::optional<TimeNs> stamp) {
  if (!stamp || *stamp < kEarliestDate) return std::nullopt;
  const std::chrono::sys_time<std::chrono::nanoseconds> time{std::chrono::nanoseconds(*stamp)};
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(time));
  return fmt::format("{:04}-{:02}-{:02}", int(day.year()), unsigned(day.month()),
                     unsigned(day.day()));
}

}  // namespace

DriveRecord drive_record(const FrameSource& source) {
  const DriveInfo& info = source.info();
  std::vector<std::optional<TimeNs>> stamps;
  for (int index = info.begin; index < info.end; ++index) stamps.push_back(source.stamp(index));
  DriveRecord drive;
  drive.name = name_of(info.path);
  drive.kind = info.kind;
  drive.calibration_fingerprint = calibration_fingerprint(info.calibration, info.lidars);
  drive.stamps_fingerprint = stamps_fingerprint(info.begin, stamps);
  drive.first_frame = info.begin;
  drive.end_frame = info.end;
  const auto first_stamp = std::find_if(stamps.begin(), stamps.end(),
                                        [](const auto& stamp) { return stamp.has_value(); });
  if (info.has_time_stamps && first_stamp != stamps.end()) drive.session = utc_day(*first_stamp);
  if (info.origin) set_origin(*info.origin, info.coordinates, drive);
  return drive;
}

void set_origin(const GeodeticPoint& origin, const CoordinateReference& coordinates,
                DriveRecord& drive) {
  drive.origin = origin;
  drive.datum = coordinates.datum.value_or(kWgs84);
  drive.epoch_year = coordinates.epoch_year;
  drive.height_type = coordinates.heights.value_or(HeightType::kEllipsoidal);
}

std::vector<SensorRecord> sensor_records(const DriveInfo& drive) {
  std::vector<SensorRecord> sensors;
  for (const MountedLidar& lidar : drive.lidars) {
    SensorRecord& sensor = sensors.emplace_back();
    sensor.profile = lidar.profile;
    sensor.T_lidar_sensor = lidar.T_lidar_sensor;
  }
  return sensors;
}

void add_views(const Frame& frame, const DriveInfo& drive, const FrameResult& result,
               FrameRecord& record) {
  FrameRecord colored;
  if (result.colors) colored.views = result.colors->views;
  for (std::size_t slot = 0; slot < frame.images.size(); ++slot) {
    if (frame.images[slot].empty()) continue;
    const Camera camera = camera_of(drive, frame, slot);
    const ViewRecord* known = colored.find_view(camera.index);
    ViewRecord view = known != nullptr ? *known : ViewRecord();
    view.camera = camera.index;
    view.stamp = frame.stamp + from_seconds(camera.image_delay);
    record.views.push_back(view);
  }
  std::sort(record.views.begin(), record.views.end(),
            [](const ViewRecord& a, const ViewRecord& b) { return a.camera < b.camera; });
}

FrameRecord skipped_record(const SkippedFrame& skipped, std::optional<TimeNs> stamp) {
  FrameRecord record;
  record.index = skipped.index;
  record.stamp = stamp;
  record.status = FrameStatus::kSkipped;
  record.note = fmt::format("{}: {}", to_string(skipped.reason), skipped.detail);
  const bool is_damaged =
      skipped.reason == SkipReason::kDamagedScan || skipped.reason == SkipReason::kDamagedImage;
  if (is_damaged) record.figures["damaged"] = 1;
  return record;
}

void note_missing_parts(const Frame& frame, FrameRecord& record) {
  for (const MissingImage& image : frame.missing_images) {
    record.count_missing_image(image.camera);
    record.note += fmt::format("{}camera {} gives nothing, {}: {}", record.note.empty() ? "" : "; ",
                               image.camera, to_string(image.reason), image.detail);
  }
  for (const MissingScan& scan : frame.missing_scans) {
    ++record.figures["scans_missing"];
    record.note += fmt::format("{}LiDAR {} gives nothing, {}: {}", record.note.empty() ? "" : "; ",
                               scan.lidar, to_string(scan.reason), scan.detail);
  }
}

}  // namespace fovea
