#include "fovea/map/map_meta.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/number_text.h"
#include "fovea/map/tile_points.h"

namespace fovea {
namespace {

/// Numbers of the meta data; nothing if the key is missing or its text is something else: a map
/// from elsewhere can hold any.
std::optional<std::vector<double>> numbers(const MapMeta& meta, const std::string& key,
                                           std::size_t count) {
  const auto found = meta.find(key);
  if (found == meta.end()) return std::nullopt;
  auto numbers = numbers_from_text(found->second);
  if (!numbers || numbers->size() != count) return std::nullopt;
  return numbers;
}

/// The submaps of a drive follow each other, in the order of the drives.
void set_submap_ranges(const std::vector<SubmapRecord>& submaps, std::vector<MergedDrive>& drives) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    drives[k].first_submap = static_cast<int>(next);
    while (next < submaps.size() && submaps[next].drive == static_cast<int>(k)) ++next;
    drives[k].end_submap = static_cast<int>(next);
  }
  if (next != submaps.size()) {
    throw InputError("the submaps are not in the order of the drives",
                     fmt::format("the map's table 'submaps', id {}", next), kRestoreMap);
  }
}

}  // namespace

std::optional<GeodeticPoint> map_origin(const MapMeta& meta) {
  const auto stated = meta.find(meta_key::kGeoreferenced);
  if (stated != meta.end() && stated->second == "0") return std::nullopt;
  const auto latitude = numbers(meta, meta_key::kOriginLatitude, 1),
             longitude = numbers(meta, meta_key::kOriginLongitude, 1),
             altitude = numbers(meta, meta_key::kOriginHeight, 1);
  if (!latitude || !longitude || !altitude) return std::nullopt;
  return GeodeticPoint{latitude->front(), longitude->front(), altitude->front()};
}

double map_tile_size(const MapMeta& meta) {
  const auto size = numbers(meta, meta_key::kTileSize, 1);
  if (!size || !(size->front() > 0 && size->front() <= kMaxTileSize)) {
    throw InputError("the map does not tell the size of its tiles", "the map's table 'meta'",
                     "give a map that 'fovea map' wrote");
  }
  return size->front();
}

std::vector<int> mapped_cameras(const MapMeta& meta) {
  const auto found = meta.find(meta_key::kCameras);
  if (found == meta.end()) return {};
  std::string text = found->second;  // "2,3"
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream numbers(text);
  std::vector<int> cameras;
  for (int camera = 0; numbers >> camera;) cameras.push_back(camera);
  return cameras;
}

std::vector<MergedDrive> merged_drives(const MapReader& map) {
  const auto held_state = map.hold_state();
  const std::vector<DriveRecord> drives = map.drives();
  std::vector<MergedDrive> merged;
  for (const DriveRecord& drive : drives) {
    if (!drive.source_digest) continue;
    merged.push_back({*drive.source_digest, drive.name, drive.first_frame, drive.end_frame,
                      drive.frame_shift, 0, 0});
  }
  if (merged.empty()) return merged;
  if (merged.size() != drives.size()) {
    throw InputError("a drive of a merged map has no digest", "the map's table 'drives'",
                     kRestoreMap);
  }
  set_submap_ranges(map.submap_records(), merged);
  return merged;
}

}  // namespace fovea
