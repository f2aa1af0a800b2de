// Exports of the frames of a map, without its points.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "fovea/map/map_store.h"

namespace fovea {

/// "frames" and "kitti-poses" have all frames, the others those with a pose of their own.
inline constexpr std::array<std::string_view, 5> kFrameFormats = {"tum", "csv", "geojson", "frames",
                                                                  "kitti-poses"};
bool is_frame_format(std::string_view format);

/// Errors as the writer of the format; InputError also if the map is damaged anywhere.
/// @param format  one of kFrameFormats
/// @param force   replaces an existing file
void write_frame_format(const MapReader& map, std::string_view format,
                        const std::filesystem::path& path, bool force);

}  // namespace fovea
