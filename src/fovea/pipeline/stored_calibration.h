// A corrected calibration in a map's meta data, and a drive seen under it.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/pipeline/self_calibration.h"

namespace fovea {

/// Puts the corrections where a reader finds them: `calibration.camera_K`, four numbers: rotation
/// vector in the camera's axes (rad), delay (s). Deviations are not kept.
void store_calibration(const std::vector<CameraCalibration>& found, MapMeta& meta);

/// Whether a map was made under a corrected calibration.
bool has_stored_calibration(const MapMeta& meta);

/// The drive with the corrections that `meta` holds applied to its cameras; those without one stay
/// as they are.
/// @param map  whose meta data it is, for errors
/// @throws InputError  if there is none at all, or one that cannot be read
std::unique_ptr<FrameSource> with_stored_calibration(std::unique_ptr<FrameSource> drive,
                                                     const MapMeta& meta,
                                                     const std::filesystem::path& map);

}  // namespace fovea
