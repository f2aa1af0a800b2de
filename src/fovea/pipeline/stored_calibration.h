// A corrected calibration in a map's meta data, and its application to a drive.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/pipeline/drive_calibration.h"

namespace fovea {

/// Stores the corrections of the cameras and the IMU (docs/map-format.md), without deviations.
void store_calibration(const DriveCalibration& found, MapMeta& meta);

/// Whether a map was made with a corrected calibration.
bool has_stored_calibration(const MapMeta& meta);

/// The drive with the corrections in `meta` applied to its cameras. Cameras without a correction do
/// not change.
/// @param map  of the meta data, for errors
/// @throws InputError  if there is no correction, or an unreadable one
std::unique_ptr<FrameSource> with_stored_calibration(std::unique_ptr<FrameSource> drive,
                                                     const MapMeta& meta,
                                                     const std::filesystem::path& map);

}  // namespace fovea
