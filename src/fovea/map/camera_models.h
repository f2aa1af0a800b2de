// The cameras of a map's drives, as its meta data state them (docs/map-format.md).
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/camera.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Stores the cameras of a drive. std::invalid_argument if a number is not finite.
/// @param drive  its number in the map
void store_camera_models(const std::vector<Camera>& cameras, std::size_t drive, MapMeta& meta);

/// The cameras of a drive by number, undistorted; empty if the map does not state them.
/// @throws InputError  if one of them cannot be read
std::vector<Camera> camera_models(const MapMeta& meta, std::size_t drive);

/// Copies the cameras of a drive to another map.
/// @param as_drive  the number of the drive there
void copy_camera_models(const MapMeta& from, std::size_t drive, std::size_t as_drive, MapMeta& to);

}  // namespace fovea
