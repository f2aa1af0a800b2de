#include "fovea/pipeline/map_drive.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/base/version.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/frame_pipeline.h"
#include "fovea/pipeline/self_calibration.h"
#include "fovea/pipeline/stored_calibration.h"

namespace fovea {
namespace {

/// A skipped frame gets a pose between its neighbours', by index: a line for every frame index.
void interpolate_skipped_poses(std::vector<FrameRecord>& records) {
  std::vector<const FrameRecord*> known;
  for (const FrameRecord& record : records) {
    if (record.status != FrameStatus::kSkipped) known.push_back(&record);
  }
  if (known.empty()) return;
  for (FrameRecord& record : records) {
    if (record.status != FrameStatus::kSkipped) continue;
    if (known.size() == 1) {
      record.T_local_lidar = known.front()->T_local_lidar;
      continue;
    }
    const auto after =
        std::upper_bound(known.begin() + 1, known.end() - 1, record.index,
                         [](int index, const FrameRecord* other) { return index < other->index; });
    const FrameRecord &a = **(after - 1), &b = **after;
    record.T_local_lidar = interpolate(a.T_local_lidar, b.T_local_lidar,
                                       double(record.index - a.index) / (b.index - a.index));
  }
}

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
  meta["fovea.version"] = version();
  meta["drive.name"] = std::filesystem::absolute(drive.path).lexically_normal().filename().string();
  meta["drive.kind"] = drive.kind;
  std::vector<int> cameras;
  for (const Camera& camera : drive.calibration.cameras) cameras.push_back(camera.index);
  meta["cameras"] = fmt::format("{}", fmt::join(cameras, ","));
  meta["frames.begin"] = fmt::format("{}", drive.begin);
  meta["frames.end"] = fmt::format("{}", drive.end);
  meta["hold_out"] = job.hold_out.spec();
  meta["poses"] = to_string(job.pose_source);
  meta["variant"] = job.variant;
  meta["calibration"] = job.calibrate ? "corrected" : "as given";
  meta["config"] = to_toml(job.options);
  meta["map.tile_size"] = fmt::format("{}", job.options.tile_size);
  meta["georeferenced"] = fmt::to_string(drive.origin ? 1 : 0);
  if (drive.origin) {
    meta["origin.latitude"] = fmt::format("{}", drive.origin->latitude);
    meta["origin.longitude"] = fmt::format("{}", drive.origin->longitude);
    meta["origin.altitude"] = fmt::format("{}", drive.origin->altitude);
  }
  meta["notes"] = fmt::format("{}", fmt::join(drive.notes, "\n"));
  return meta;
}

struct EarlierRun {
  TileMap map;
  std::vector<FrameRecord> records;
};

/// Reads what an interrupted run left; InputError if it was made with other settings.
EarlierRun read_earlier_run(const MapJob& job, const MapMeta& meta) {
  const MapReader reader(job.output);
  const MapMeta before = reader.meta();
  for (const auto& [key, value] : meta) {
    const auto found = before.find(key);
    if (found == before.end() || found->second != value) {
      throw InputError(fmt::format("the map was made with another '{}'", key), job.output.string(),
                       "resume with the drive and settings of the first run, or start a new map");
    }
  }
  EarlierRun run{TileMap(job.options.tile_size), reader.frames()};
  for (const RigidMotion& T_local_submap : reader.submaps()) run.map.add_submap(T_local_submap);
  reader.for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
    run.map.restore_tile(submap, key, tile);
  });
  return run;
}

FrameRecord skipped_record(const SkippedFrame& skipped, std::optional<TimeNs> stamp) {
  FrameRecord record;
  record.index = skipped.index;
  record.stamp = stamp;
  record.status = FrameStatus::kSkipped;
  record.note = fmt::format("{}: {}", to_string(skipped.reason), skipped.detail);
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
FrameRecord map_frame(Mapper& mapper, const FrameSource& source, LocatedFrame& located) {
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
  return record;
}

void store_map(MapWriter& writer, const MapMeta& meta, const std::vector<FrameRecord>& records,
               const TileMap& map, bool complete) {
  for (const auto& [key, value] : meta) writer.put_meta(key, value);
  writer.put_meta("complete", complete ? "1" : "0");
  for (const FrameRecord& record : records) writer.put_frame(record);
  for (std::size_t id = 0; id < map.submaps().size(); ++id) {
    writer.put_submap(id, map.submaps()[id].T_local_submap);
    for (const auto& [key, tile] : map.submaps()[id].tiles) writer.put_tile(id, key, tile);
  }
  writer.commit();
}

bool has_sweep_motion(const DriveInfo& drive, const MapJob& job) {
  return job.options.compensate_motion && !drive.sweep_compensated;
}

std::vector<CameraCalibration> calibrate(const FrameSource& source, const MapJob& job) {
  CalibrationJob calibration;
  calibration.compensate = has_sweep_motion(source.info(), job);
  calibration.usable = [&](int index) { return !job.hold_out.contains(index); };
  calibration.motion = [&](int index) { return known_motion(source, job.given_poses, index); };
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

void check_calibration(CalibrationCheck& check, const LocatedFrame& located,
                       std::vector<FrameRecord>& records) {
  if (records.back().status != FrameStatus::kMapped) return;
  const Frame& frame = std::get<Frame>(located.result);
  if (!check.wants(frame.index)) return;
  const WallClock::time_point start = WallClock::now();
  if (const auto motion = mapped_motion(records)) check.add(frame, *motion);
  records.back().milliseconds["calibration"] = milliseconds_since(start);
}

/// Appends to the records of an earlier run.
void map_frames(const FrameSource& source, const MapJob& job, Mapper& mapper,
                CalibrationCheck* check, std::vector<FrameRecord>& records,
                const std::function<void(const MapProgress&)>& progress) {
  const DriveInfo& drive = source.info();
  const int total = drive.end - drive.begin;
  const auto track = [&](const Frame& frame) {
    std::optional<RigidMotion> given;
    const auto place = static_cast<std::size_t>(frame.index - drive.begin);
    if (place < job.given_poses.size()) given = job.given_poses[place];
    return mapper.track(frame, job.hold_out.contains(frame.index), given);
  };
  FramePipeline frames(source, drive.begin + static_cast<int>(records.size()), drive.end, track,
                       {job.rate, job.overlap && available_threads() > 1, job.stop});
  while (std::optional<LocatedFrame> located = frames.next()) {
    records.push_back(map_frame(mapper, source, *located));
    if (check != nullptr) check_calibration(*check, *located, records);
    if (progress) {
      progress({static_cast<int>(records.size()), total, mapper.map().size(), &records.back()});
    }
  }
}

/// InputError if the drive does not say of its motion what the job has to know.
void require_motion(const DriveInfo& drive, const MapJob& job) {
  if (job.pose_source == PoseSource::kNavigation && !drive.navigation) {
    throw InputError("the drive has no navigation to take poses from", drive.path.string(),
                     "let registration find them (--poses refine)");
  }
  if (job.calibrate && !drive.navigation && job.given_poses.empty()) {
    throw InputError("nothing says how the vehicle moves, which a calibration needs",
                     drive.path.string(), "give poses (--poses FILE) or map without --calibrate");
  }
}

void require_mapped(const std::vector<FrameRecord>& records, const DriveInfo& drive) {
  if (std::none_of(records.begin(), records.end(),
                   [](const FrameRecord& r) { return r.status != FrameStatus::kSkipped; })) {
    throw InputError("no frame could be mapped",
                     records.empty() ? drive.path.string() : records.front().note,
                     "check that the drive has scans and images for the frames asked for");
  }
}

}  // namespace

MapSummary map_drive(const FrameSource& source, const MapJob& job,
                     const std::function<void(const MapProgress&)>& progress) {
  const WallClock::time_point start = WallClock::now();
  DriveInfo drive = source.info();
  require_motion(drive, job);
  MapMeta meta = describe(drive, job);
  const auto writer =
      job.resume ? MapWriter::open(job.output) : MapWriter::create(job.output, job.force);

  const std::vector<CameraCalibration> correction = correct_calibration(source, job, drive, meta);
  Mapper mapper(drive, job.options, job.pose_source);
  std::vector<FrameRecord> records;
  if (job.resume) {
    EarlierRun run = read_earlier_run(job, meta);
    records = std::move(run.records);
    mapper.resume(std::move(run.map), records, source);
  }
  const std::size_t first_new = records.size();
  const int total = drive.end - drive.begin;

  std::optional<CalibrationCheck> check;
  if (job.options.check_calibration && !job.calibrate) {
    check.emplace(drive, has_sweep_motion(drive, job));
  }
  map_frames(source, job, mapper, check ? &*check : nullptr, records, progress);
  require_mapped(records, drive);
  const bool complete = static_cast<int>(records.size()) == total;
  mapper.settle(records);
  interpolate_skipped_poses(records);
  store_map(*writer, meta, records, mapper.map(), complete);

  MapSummary summary = summarise(records, first_new, drive, job.rate);
  if (job.pose_source == PoseSource::kGivenFirst) {
    summary.notes.push_back(
        fmt::format("{} poses for {} frames: the frames after them are registered",
                    job.given_poses.size(), total));
  }
  summary.points = mapper.map().size();
  summary.interrupted = !complete;
  summary.calibration = check ? check->estimates() : correction;
  summary.calibrated = job.calibrate;
  summary.frames_per_second =
      double(records.size() - first_new) / (milliseconds_since(start) / 1000);
  return summary;
}

}  // namespace fovea
