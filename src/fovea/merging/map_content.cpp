#include "fovea/merging/map_content.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "fovea/errors.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/map/meta_keys.h"

namespace fovea {
namespace {

/// Puts what a merged map states of a drive into its record.
void describe(const MergedDrive& drive, DriveRecord& record) {
  record.name = drive.name;
  record.source_digest = drive.digest;
  record.first_frame = drive.first_frame;
  record.end_frame = drive.end_frame;
  record.frame_shift = drive.frame_shift;
}

/// The drive of a map that is not merged.
MergedDrive only_drive(const MapReader& map, const MapContent& content, bool with_digest) {
  MergedDrive drive;
  drive.digest = with_digest ? map.digest() : map.identity();
  drive.name = content.text(meta_key::kDriveName);
  if (!content.frames.empty()) {
    drive.first_frame = content.frames.front().index;
    drive.end_frame = content.frames.back().index + 1;
  }
  drive.end_submap = static_cast<int>(content.T_local_submap.size());
  return drive;
}

}  // namespace

MapContent::MapContent(const MapReader& map, bool with_digest)
    : meta(map.meta()),
      frames(map.frames()),
      T_local_submap(map.submaps()),
      drives(merged_drives(map)),
      records(map.drives()),
      sensors(map.sensors()),
      tile_size(map_tile_size(meta)) {
  is_merged = !drives.empty();
  if (!is_merged) {
    drives.push_back(only_drive(map, *this, with_digest));
    records.resize(1);
  }
  for (std::size_t k = 0; k < drives.size(); ++k) describe(drives[k], records[k]);
  for (const FrameRecord& frame : frames) {
    if (frame.submap < int(T_local_submap.size())) continue;
    throw InputError(fmt::format("frame {} is of a submap that is not there", frame.index),
                     "the map's table 'frames'", kRestoreMap);
  }
}

void require_one_drive(const MapContent& map, const std::string& where) {
  if (!map.is_merged) return;
  throw InputError("a merged map is no part of a city", where, "give the maps that it was made of");
}

std::string MapContent::text(const std::string& key) const {
  const auto found = meta.find(key);
  return found == meta.end() ? "" : found->second;
}

const MergedDrive* find_drive(const MapContent& map, const std::string& digest) {
  const auto found = std::find_if(map.drives.begin(), map.drives.end(),
                                  [&](const MergedDrive& drive) { return drive.digest == digest; });
  return found == map.drives.end() ? nullptr : &*found;
}

std::vector<AddedDrive> drives_to_add(const MapContent& a, const MapContent& b) {
  std::vector<AddedDrive> added;
  int frame = a.end_frame();
  auto submap = static_cast<int>(a.T_local_submap.size());
  for (std::size_t k = 0; k < b.drives.size(); ++k) {
    const MergedDrive& drive = b.drives[k];
    if (find_drive(a, drive.digest) != nullptr) continue;
    MergedDrive merged = drive;
    merged.first_frame = frame;
    constexpr int kMostFrames = 1 << 30;
    if (drive.first_frame < 0 || drive.end_frame - drive.first_frame > kMostFrames - frame) {
      throw InputError("the maps have more frames than one can number", drive.name,
                       "merge maps of shorter drives");
    }
    frame += drive.end_frame - drive.first_frame;
    merged.end_frame = frame;
    merged.frame_shift += merged.first_frame - drive.first_frame;
    merged.first_submap = submap;
    submap += drive.end_submap - drive.first_submap;
    merged.end_submap = submap;
    DriveRecord record = b.records[k];
    describe(merged, record);
    added.push_back({drive, merged, record, k, a.drives.size() + added.size()});
  }
  return added;
}

std::optional<RigidMotion> stated_T_a_b(const MapContent& a, const MapContent& b) {
  for (const MergedDrive& drive : b.drives) {
    const MergedDrive* same = find_drive(a, drive.digest);
    if (same == nullptr || drive.first_submap == drive.end_submap) continue;
    return a.T_local_submap.at(std::size_t(same->first_submap)) *
           b.T_local_submap.at(std::size_t(drive.first_submap)).inverse();
  }
  const auto origin_a = map_origin(a.meta), origin_b = map_origin(b.meta);
  if (!origin_a || !origin_b) return std::nullopt;
  return LocalTangentPlane(*origin_a).T_local_enu(*origin_b);
}

std::string cameras_of(const std::vector<const MapContent*>& maps) {
  std::set<int> cameras;
  for (const MapContent* map : maps) {
    const std::vector<int> mapped = mapped_cameras(map->meta);
    cameras.insert(mapped.begin(), mapped.end());
  }
  return fmt::format("{}", fmt::join(cameras, ","));
}

std::vector<std::optional<Eigen::Vector3d>> submap_middles(const std::vector<FrameRecord>& frames,
                                                           std::size_t submaps) {
  std::vector<std::vector<Eigen::Vector3d>> positions(submaps);
  for (const FrameRecord& frame : frames) {
    if (frame.submap < 0 || std::size_t(frame.submap) >= submaps) continue;
    positions[std::size_t(frame.submap)].push_back(frame.T_local_lidar.translation());
  }
  std::vector<std::optional<Eigen::Vector3d>> middles(submaps);
  for (std::size_t id = 0; id < submaps; ++id) {
    if (!positions[id].empty()) middles[id] = positions[id][positions[id].size() / 2];
  }
  return middles;
}

}  // namespace fovea
