#include "fovea/merging/merge_maps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/map/map_meta.h"
#include "fovea/mapping/exposure.h"
#include "fovea/merging/map_gain.h"

namespace fovea {
namespace {

/// What is read of a map before its points.
struct MapContent {
  explicit MapContent(const MapReader& map)
      : meta(map.meta()),
        frames(map.frames()),
        T_local_submap(map.submaps()),
        tile_size(map_tile_size(meta)) {
    drives = merged_drives(meta);
    for (const MergedDrive& drive : drives) {
      if (std::size_t(drive.end_submap) > T_local_submap.size()) {
        throw InputError(fmt::format("the submaps of its drive '{}' are missing", drive.name),
                         "the map's table 'submaps'", kRestoreMap);
      }
    }
    if (drives.empty()) drives.push_back(only_drive(map));
  }

  MergedDrive only_drive(const MapReader& map) const {
    MergedDrive drive;
    drive.digest = map.digest();
    drive.name = text("drive.name");
    if (!frames.empty()) {
      drive.first_frame = frames.front().index;
      drive.end_frame = frames.back().index + 1;
    }
    drive.end_submap = static_cast<int>(T_local_submap.size());
    return drive;
  }

  std::string text(const std::string& key) const {
    const auto found = meta.find(key);
    return found == meta.end() ? "" : found->second;
  }
  int end_frame() const { return drives.back().end_frame; }

  MapMeta meta;
  std::vector<FrameRecord> frames;
  std::vector<RigidMotion> T_local_submap;
  std::vector<MergedDrive> drives;  // one at least
  double tile_size = 0;             // m
};

const MergedDrive* find_drive(const MapContent& map, const std::string& digest) {
  const auto found = std::find_if(map.drives.begin(), map.drives.end(),
                                  [&](const MergedDrive& drive) { return drive.digest == digest; });
  return found == map.drives.end() ? nullptr : &*found;
}

/// How the local frames of the maps lie to each other, as far as they tell; nothing if they do not.
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

/// A drive of B that A has not, and what becomes of it.
struct AddedDrive {
  MergedDrive in_b, merged;

  /// Of one of its frames; -1 for another one, which a damaged map may name.
  int number_of(int frame_in_b) const {
    if (frame_in_b < in_b.first_frame || frame_in_b >= in_b.end_frame) return -1;
    return merged.first_frame + (frame_in_b - in_b.first_frame);
  }
};

std::vector<AddedDrive> drives_to_add(const MapContent& a, const MapContent& b) {
  std::vector<AddedDrive> added;
  int frame = a.end_frame();
  auto submap = static_cast<int>(a.T_local_submap.size());
  for (const MergedDrive& drive : b.drives) {
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
    added.push_back({drive, merged});
  }
  return added;
}

void require_fit(const MapContent& a, const MapContent& b, const std::string& where) {
  if (a.tile_size != b.tile_size) {
    throw InputError(
        fmt::format("the maps' tiles differ in size, {} m and {} m", a.tile_size, b.tile_size),
        where, "map one of the drives again with the other's map.tile_size");
  }
}

void require_overlap(const MapAlignment& alignment, const std::string& where) {
  if (alignment.registered > 0) return;
  if (alignment.met == 0) {
    throw InputError("the maps do not overlap", where,
                     "give maps of one place, or put them into one map all the same (--force)");
  }
  throw InputError("the maps overlap, but nowhere do their surfaces fit", where,
                   "check that both are georeferenced well, or merge them by that alone (--force)");
}

std::string cameras_of_both(const MapContent& a, const MapContent& b) {
  std::set<int> cameras;
  for (const MapContent* map : {&a, &b}) {
    std::string text = map->text("cameras");
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream numbers(text);
    for (int camera = 0; numbers >> camera;) cameras.insert(camera);
  }
  return fmt::format("{}", fmt::join(cameras, ","));
}

/// A frame of a drive as it is in the merged map.
FrameRecord moved_frame(FrameRecord frame, const AddedDrive& drive, const MapContent& b,
                        const MapAlignment& alignment, const RigidMotion& stated_T_a_b,
                        std::size_t& latest_submap) {
  const int to_submap = drive.merged.first_submap - drive.in_b.first_submap;
  if (frame.submap >= 0) latest_submap = std::size_t(frame.submap);  // a skipped one goes along
  frame.T_local_lidar = alignment.T_a_submap.at(latest_submap) *
                        b.T_local_submap.at(latest_submap).inverse() * frame.T_local_lidar;
  if (frame.T_local_lidar_navigation) {
    frame.T_local_lidar_navigation = stated_T_a_b * *frame.T_local_lidar_navigation;
  }
  frame.index = drive.number_of(frame.index);
  if (frame.submap >= 0) frame.submap += to_submap;
  if (frame.revisit && frame.revisit->submap >= 0) frame.revisit->submap += to_submap;
  return frame;
}

/// B's colours, made as bright as A's.
void match_exposure(const Eigen::Array3f& gain, PointCloud& tile) {
  if ((gain == 1).all()) return;
  const std::uint8_t mark = is_exposure_off(gain) ? kExposureMatched : 0;
  for (std::size_t i = 0; i < tile.size(); ++i) {
    if (tile.camera[i] == kNoCamera) continue;
    const Eigen::Array3f color = (to_float(tile.color[i]).array() * gain + 0.5f).min(255.0f);
    tile.color[i] = {std::uint8_t(color[0]), std::uint8_t(color[1]), std::uint8_t(color[2])};
    tile.reason[i] |= mark;
  }
}

/// Puts both maps into one file, as they are, and where their tiles are into `map`.
class MapJoiner {
 public:
  MapJoiner(const MapReader& a, const MapReader& b, MapWriter& output, TileMap& map)
      : a_(a), b_(b), output_(output), map_(map) {}

  void copy_a(const MapContent& content) {
    copy_all_but_tiles(a_, output_);
    for (const RigidMotion& T : content.T_local_submap) map_.add_submap(T);
    a_.for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
      put_tile({submap, key}, tile);
    });
  }

  void add_b(const MapContent& content, const std::vector<AddedDrive>& drives,
             const MapAlignment& alignment, const RigidMotion& stated_T_a_b,
             const Eigen::Array3f& gain) {
    // Of each submap of B the drive that it comes with, if it does.
    std::vector<const AddedDrive*> drive_of(content.T_local_submap.size(), nullptr);
    for (const AddedDrive& drive : drives) {
      for (int id = drive.in_b.first_submap; id < drive.in_b.end_submap; ++id) {
        drive_of.at(std::size_t(id)) = &drive;
        add_submap(alignment.T_a_submap.at(std::size_t(id)));
      }
      auto latest_submap = std::size_t(drive.in_b.first_submap);
      for (const FrameRecord& frame : content.frames) {
        if (drive.number_of(frame.index) < 0) continue;
        output_.put_frame(
            moved_frame(frame, drive, content, alignment, stated_T_a_b, latest_submap));
      }
    }
    b_.for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
      const AddedDrive* drive = drive_of[submap];
      if (drive == nullptr) return;
      PointCloud moved = tile;
      match_exposure(gain, moved);
      for (std::int32_t& frame : moved.frame) frame = drive->number_of(frame);
      put_tile({submap + std::size_t(drive->merged.first_submap - drive->in_b.first_submap), key},
               std::move(moved));
    });
  }

 private:
  void add_submap(const RigidMotion& T_local_submap) {
    output_.put_submap(map_.submaps().size(), T_local_submap);
    map_.add_submap(T_local_submap);
  }
  void put_tile(const TileId& id, PointCloud tile) {
    // A map has intensities in all tiles or in none.
    if (!has_intensity_) has_intensity_ = !tile.intensity.empty();
    if (!*has_intensity_) tile.intensity.clear();
    if (*has_intensity_ && tile.intensity.empty()) tile.intensity.assign(tile.size(), 0.0f);
    output_.put_tile(id, tile);
    map_.declare_stored(id, tile.size());
  }

  const MapReader& a_;
  const MapReader& b_;
  MapWriter& output_;
  TileMap& map_;
  std::optional<bool> has_intensity_;
};

MapMeta merged_meta(const MapContent& a, const MapContent& b,
                    const std::vector<AddedDrive>& added) {
  MapMeta meta = a.meta;
  std::vector<MergedDrive> drives = a.drives;
  for (const AddedDrive& drive : added) drives.push_back(drive.merged);
  set_merged_drives(drives, meta);
  meta["frames.end"] = fmt::to_string(drives.back().end_frame);
  meta["cameras"] = cameras_of_both(a, b);
  if (b.text("complete") != "1") meta["complete"] = fmt::to_string(0);
  meta.erase(kSchemaVersionKey);
  return meta;
}

/// How the two lie to each other and differ in brightness, into the figures.
/// @return T_a_b of the local frames as stated, or identity
RigidMotion compare(const MapReader& a, const MapReader& b, const MapContent& content_a,
                    const MapContent& content_b, const MergeJob& job, MergeFigures& figures) {
  const std::string where = job.output.string();
  const auto stated = stated_T_a_b(content_a, content_b);
  figures.georeferenced = stated.has_value();
  if (!stated && !job.force) {
    throw InputError("a map without georeference: nothing says how the two lie to each other",
                     where, "merge them as if they had one local frame (--force)");
  }
  const RigidMotion T_a_b = stated.value_or(RigidMotion::Identity());
  if (figures.drives_added > 0) {
    MapSurfaces surfaces_a(a), surfaces_b(b);
    figures.alignment = align_maps(surfaces_a, surfaces_b, content_b.frames, T_a_b);
    if (!job.force) require_overlap(figures.alignment, where);
    figures.gain = gain_of_maps(a, b, figures.alignment.T_a_submap, content_a.tile_size);
  }
  return T_a_b;
}

}  // namespace

MergeFigures merge_maps(const MapReader& a, const MapReader& b, const MergeJob& job) {
  const auto held_a = a.hold_state(), held_b = b.hold_state();
  const MapContent content_a(a), content_b(b);
  require_fit(content_a, content_b, job.output.string());
  const std::vector<AddedDrive> added = drives_to_add(content_a, content_b);
  MergeFigures figures;
  figures.drives_added = added.size();
  const RigidMotion T_a_b = compare(a, b, content_a, content_b, job, figures);

  TileMap map(content_a.tile_size);
  auto writer = MapWriter::create(job.output, job.force);
  MapJoiner joiner(a, b, *writer, map);
  joiner.copy_a(content_a);
  if (added.empty()) {
    writer->commit();
  } else {
    joiner.add_b(content_b, added, figures.alignment, T_a_b, figures.gain);
    for (const auto& [key, value] : merged_meta(content_a, content_b, added)) {
      writer->put_meta(key, value);
    }
    MapKeeper keeper(std::move(writer),
                     {available_threads() > 1, job.memory, /*commit_at_end=*/true});
    figures.merged = merge_points(map, content_a.T_local_submap.size(), job.spacing, keeper);
    keeper.finish(map, {});
  }
  figures.points = map.size();
  return figures;
}

}  // namespace fovea
