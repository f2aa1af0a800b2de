#include "fovea/merging/merge_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/map/camera_models.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/tile_cache.h"
#include "fovea/merging/map_gain.h"
#include "fovea/merging/map_joiner.h"

namespace fovea {
namespace {

void require_fit(const MapContent& a, const MapContent& b, const std::string& where) {
  if (a.tile_size != b.tile_size) {
    throw InputError(
        fmt::format("the maps' tiles differ in size, {} m and {} m", a.tile_size, b.tile_size),
        where, "map one of the drives again with the other's map.tile_size_m");
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

MapMeta merged_meta(const MapContent& a, const MapContent& b,
                    const std::vector<AddedDrive>& added) {
  MapMeta meta = a.meta;
  meta[meta_key::kFramesEnd] = fmt::to_string(added.back().merged.end_frame);
  meta[meta_key::kCameras] = cameras_of({&a, &b});
  for (const AddedDrive& drive : added) {
    copy_camera_models(b.meta, drive.number_in_b, drive.number, meta);
  }
  if (b.text(meta_key::kComplete) != "1") meta[meta_key::kComplete] = fmt::to_string(0);
  for (const char* key : {meta_key::kCrop, meta_key::kRepair}) {
    const std::string text = b.text(key);
    if (text.empty()) continue;
    std::string& both = meta[key];
    both += fmt::format("{}{} ({})", both.empty() ? "" : "; ", text, b.drives.front().name);
  }
  meta.erase(meta_key::kFormatVersion);
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
    figures.gain_of_b = gain_of_maps(a, b, figures.alignment.T_a_submap, content_a.tile_size);
  }
  return T_a_b;
}

}  // namespace

MergeFigures merge_maps(const MapReader& a, const MapReader& b, const MergeJob& job) {
  const auto held_a = a.hold_state(), held_b = b.hold_state();
  const MapContent content_a(a, /*with_digest=*/true), content_b(b, /*with_digest=*/true);
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
    writer->finish();
  } else {
    const Renumbering renumbering(content_a, content_b, added);
    put_drives(content_a, added, renumbering, T_a_b, *writer);
    joiner.add_b(content_b, added, renumbering, figures.alignment, T_a_b, figures.gain_of_b);
    for (const auto& [key, value] : merged_meta(content_a, content_b, added)) {
      writer->put_meta(key, value);
    }
    Checkpointer file(std::move(writer),
                      {available_threads() > 1, job.memory, /*commit_at_end=*/true});
    TileCache cache(file, job.memory);
    figures.merged = merge_points(map, content_a.T_local_submap.size(), job.spacing, file, cache);
    file.finish(map, {});
  }
  figures.points = map.size();
  return figures;
}

}  // namespace fovea
