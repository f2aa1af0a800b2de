#include "fovea/map/map_meta.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/base/errors.h"
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

std::string key_of(std::size_t drive, const char* what) {
  return fmt::format("merged.{}.{}", drive, what);
}

/// Whole numbers, of which the first two are a range.
std::vector<int> range(const MapMeta& meta, const std::string& key, std::size_t count) {
  constexpr double kMost = 1 << 30;
  std::vector<int> range;
  for (const double value : numbers(meta, key, count).value_or(std::vector<double>())) {
    const auto number = static_cast<int>(std::clamp(value, -kMost, kMost));
    if (value == number) range.push_back(number);
  }
  if (range.size() != count || range[0] < 0 || range[1] < range[0]) {
    throw InputError(fmt::format("'{}' is missing or cannot be read", key),
                     "the map's table 'meta'", "restore the map from a copy or merge again");
  }
  return range;
}

}  // namespace

std::optional<GeodeticPoint> map_origin(const MapMeta& meta) {
  const auto stated = meta.find("georeferenced");
  if (stated != meta.end() && stated->second == "0") return std::nullopt;
  const auto latitude = numbers(meta, "origin.latitude", 1),
             longitude = numbers(meta, "origin.longitude", 1),
             altitude = numbers(meta, "origin.altitude", 1);
  if (!latitude || !longitude || !altitude) return std::nullopt;
  return GeodeticPoint{latitude->front(), longitude->front(), altitude->front()};
}

double map_tile_size(const MapMeta& meta) {
  const auto size = numbers(meta, "map.tile_size", 1);
  if (!size || !(size->front() > 0 && size->front() <= kMaxTileSize)) {
    throw InputError("the map does not tell the size of its tiles", "the map's table 'meta'",
                     "give a map that 'fovea map' wrote");
  }
  return size->front();
}

std::vector<MergedDrive> merged_drives(const MapMeta& meta) {
  std::vector<MergedDrive> drives;
  for (std::size_t k = 1; meta.contains(key_of(k, "digest")); ++k) {
    const std::vector<int> frames = range(meta, key_of(k, "frames"), 3);
    const std::vector<int> submaps = range(meta, key_of(k, "submaps"), 2);
    const auto name = meta.find(key_of(k, "name"));
    drives.push_back({meta.at(key_of(k, "digest")), name == meta.end() ? "" : name->second,
                      frames[0], frames[1], frames[2], submaps[0], submaps[1]});
  }
  return drives;
}

void set_merged_drives(const std::vector<MergedDrive>& drives, MapMeta& meta) {
  std::erase_if(meta, [](const auto& entry) { return entry.first.starts_with("merged."); });
  for (std::size_t k = 1; k <= drives.size(); ++k) {
    const MergedDrive& drive = drives[k - 1];
    meta[key_of(k, "digest")] = drive.digest;
    meta[key_of(k, "name")] = drive.name;
    meta[key_of(k, "frames")] =
        fmt::format("{} {} {}", drive.first_frame, drive.end_frame, drive.frame_shift);
    meta[key_of(k, "submaps")] = fmt::format("{} {}", drive.first_submap, drive.end_submap);
  }
}

}  // namespace fovea
