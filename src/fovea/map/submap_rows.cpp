#include "fovea/map/submap_rows.h"

#include <map>
#include <string>
#include <utility>

#include "fovea/map/numbered_records.h"
#include "fovea/map/record_rows.h"

namespace fovea {
namespace {

/// Gives each missing submap that has frames the pose of its first frame, where it begins.
void restore_submaps(MapFile& file, std::vector<SubmapRecord>& submaps,
                     std::set<std::size_t>& missing) {
  std::map<std::size_t, FrameRecord> first_frames;
  file.for_each_row(kFramesTable, [&](const Row& row) {
    FrameRecord frame = frame_of(RowCursor(kFramesTable, row, file.where()));
    if (frame.submap >= 0) first_frames.try_emplace(std::size_t(frame.submap), std::move(frame));
  });
  std::vector<DriveRecord> drives;
  file.read([&] { drives = numbered_records<DriveRecord>(file, kDrivesTable, drive_of); });
  for (const auto& [id, frame] : first_frames) {
    // Submaps without gaps only: a forged number must not take memory.
    if (id == submaps.size()) {
      missing.insert(id);
      submaps.emplace_back();
    }
    if (missing.erase(id) == 0) continue;
    submaps[id].T_local_submap = frame.T_local_lidar;
    for (std::size_t k = 0; k < drives.size(); ++k) {
      const bool is_its = frame.index >= drives[k].first_frame && frame.index < drives[k].end_frame;
      if (is_its) submaps[id].drive = static_cast<int>(k);
    }
  }
}

}  // namespace

MapMeta stored_meta(MapFile& file) {
  MapMeta meta;
  file.for_each_row(kMetaTable, [&](const Row& row) {
    RowCursor cursor(kMetaTable, row, file.where());
    std::string key = cursor.text();
    meta.emplace(std::move(key), cursor.text());
  });
  return meta;
}

std::vector<SubmapRecord> read_submaps(MapFile& file, std::set<std::size_t>& missing) {
  std::vector<SubmapRecord> submaps =
      numbered_records<SubmapRecord>(file, kSubmapsTable, submap_of, missing);
  if (file.reports_damage()) restore_submaps(file, submaps, missing);
  if (file.format().submap_drives != nullptr) {
    const std::vector<int> drives = file.format().submap_drives(stored_meta(file), submaps.size());
    for (std::size_t id = 0; id < submaps.size(); ++id) submaps[id].drive = drives[id];
  }
  return submaps;
}

}  // namespace fovea
