#include "fovea/pipeline/earlier_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "fovea/errors.h"
#include "fovea/map/drive_fingerprint.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/drive_match.h"
#include "fovea/pipeline/drive_records.h"

namespace fovea {
namespace {

/// Keys whose values contain the path of the drive.
constexpr std::array kNames{meta_key::kDriveName, meta_key::kNotes};

constexpr std::array kOrigin{meta_key::kGeoreferenced, meta_key::kOriginLatitude,
                             meta_key::kOriginLongitude, meta_key::kOriginHeight};

/// " (8:4, now 8:3)" if both values are short.
std::string change(const std::string& before, const std::string& now) {
  constexpr std::size_t kLongest = 30;
  if (std::max(before.size(), now.size()) > kLongest) return "";
  return fmt::format(" ('{}', now '{}')", before, now);
}

void require_resumable(const MapReader& map, const MapMeta& meta, const std::string& path) {
  if (meta.contains(meta_key::kCrop)) {
    throw InputError("the map is a part of another one", path,
                     "resume the whole map, or start a new one");
  }
  if (meta.contains(meta_key::kRepair)) {
    throw InputError("the map was repaired and lacks parts", path, "start a new map");
  }
  if (!merged_drives(map).empty()) {
    throw InputError("the map is of several drives", path,
                     "resume the map of one drive, and merge it when it is whole");
  }
}

void require_same_values(const MapMeta& before, const MapMeta& now, const std::string& path) {
  for (const auto& [key, value] : now) {
    if (std::count(kNames.begin(), kNames.end(), key) > 0) continue;
    // The fingerprints of the drive compare the cameras. Older maps do not have these keys.
    if (key.starts_with(meta_key::kCameraModelPrefix)) continue;
    const auto found = before.find(key);
    if (found != before.end() && found->second == value) continue;
    const std::string values = found == before.end() ? "" : change(found->second, value);
    throw InputError(fmt::format("the map was made with another '{}'{}", key, values), path,
                     "resume with the drive and settings of the first run, or start a new map");
  }
}

[[noreturn]] void throw_other_drive(const std::string& difference, const std::string& path) {
  throw InputError(fmt::format("the map was made of a drive with {}", difference), path,
                   "resume with the drive of the first run, or start a new map");
}

/// Takes the place of an earlier run, for one without navigation so far.
void keep_origin(const MapMeta& before, const DriveRecord& earlier, MapMeta& meta,
                 DriveRecord& record) {
  for (const char* key : kOrigin) {
    if (const auto found = before.find(key); found != before.end()) meta[key] = found->second;
  }
  record.origin = earlier.origin;
  record.datum = earlier.datum;
  record.epoch_year = earlier.epoch_year;
  record.height_type = earlier.height_type;
}

/// A calibration without the place of the IMU, if only one of two states it: it comes with
/// navigation, which a live drive may begin without.
std::string comparable(const std::string& calibration, const std::string& other) {
  const bool is_stated = fingerprint_parts(other).contains("imu");
  return is_stated ? calibration : without_imu(calibration);
}

void require_same_drive(const DriveRecord& before, const DriveRecord& now,
                        const std::string& path) {
  std::string difference;
  const auto calibration = calibration_difference(*before.calibration_fingerprint,
                                                  now.calibration_fingerprint.value_or(""));
  if (calibration) difference = fmt::format("another calibration ({})", *calibration);
  if (before.stamps_fingerprint != now.stamps_fingerprint) difference = "other stamps";
  if (!difference.empty()) throw_other_drive(difference, path);
}

}  // namespace

bool is_complete(const MapMeta& meta) {
  const auto stated = meta.find(meta_key::kComplete);
  return stated != meta.end() && stated->second == "1";
}

void require_same_live_run(const MapReader& map, MapMeta& meta, DriveRecord& record,
                           const std::filesystem::path& path) {
  const MapMeta before = map.meta();
  require_resumable(map, before, path.string());
  const std::vector<DriveRecord> drives = map.drives();
  if (drives.size() != 1 || !drives[0].calibration_fingerprint) {
    throw InputError("the map does not state which drive it is of", path.string(),
                     "start a new map");
  }
  record.first_frame = drives[0].first_frame;
  record.session = drives[0].session;
  for (const char* key : {meta_key::kFramesBegin, meta_key::kFramesEnd}) {
    if (const auto found = before.find(key); found != before.end()) meta[key] = found->second;
  }
  DriveRecord earlier = drives[0];
  if (earlier.origin && !record.origin) keep_origin(before, earlier, meta, record);
  MapMeta compared = meta;
  if (!earlier.origin) {
    for (const char* key : kOrigin) compared.erase(key);  // navigation may begin now
  }
  require_same_values(before, compared, path.string());
  DriveRecord now = record;
  record.stamps_fingerprint = now.stamps_fingerprint = earlier.stamps_fingerprint;
  const std::string& calibration = now.calibration_fingerprint.emplace(
      comparable(record.calibration_fingerprint.value_or(""), *earlier.calibration_fingerprint));
  earlier.calibration_fingerprint = comparable(*earlier.calibration_fingerprint, calibration);
  require_same_drive(earlier, now, path.string());
}

void require_same_run(const MapReader& map, const MapMeta& meta, const DriveRecord& record,
                      const FrameSource& drive, const std::filesystem::path& path) {
  const MapMeta before = map.meta();
  require_resumable(map, before, path.string());
  MapMeta origin;  // other drives may have the same
  for (const char* key : kOrigin) {
    if (const auto found = meta.find(key); found != meta.end()) origin.insert(*found);
  }
  MapMeta settings = meta;
  for (const auto& [key, value] : origin) settings.erase(key);
  if (before.contains(meta_key::kImu) && !meta.contains(meta_key::kImu)) {
    throw InputError("the map was made with an IMU", path.string(),
                     "resume with the drive and options of the first run, or start a new map");
  }
  require_same_values(before, settings, path.string());
  const std::vector<DriveRecord> drives = map.drives();
  if (drives.size() != 1 || !drives[0].calibration_fingerprint || !drives[0].stamps_fingerprint) {
    throw InputError("the map does not state which drive it is of", path.string(),
                     "start a new map");
  }
  require_same_drive(drives[0], record, path.string());
  const std::vector<FrameRecord> frames = map.frames();
  std::map<int, int> numbers;
  for (const FrameRecord& frame : frames) numbers.emplace(frame.index, frame.index);
  if (const auto difference = scan_difference(frames, numbers, drive, /*allow_thinned=*/false)) {
    throw_other_drive(fmt::format("other scans: {}", *difference), path.string());
  }
  require_same_values(before, origin, path.string());
}

void keep_names(const MapReader& map, MapMeta& meta, DriveRecord& drive) {
  const MapMeta before = map.meta();
  for (const char* key : kNames) {
    const auto found = before.find(key);
    if (found != before.end()) meta[key] = found->second;
  }
  for (const DriveRecord& stored : map.drives()) drive.name = stored.name;
}

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

}  // namespace fovea
