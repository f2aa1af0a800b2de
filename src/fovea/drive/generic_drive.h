// Drives of any vehicle: a folder with a drive.toml (docs/drives.md).
#pragma once

#include <filesystem>
#include <memory>

#include "fovea/drive/frame_source.h"

namespace fovea {

/// Opens the drive. ConfigError for what drive.toml says wrongly and for cameras and frames that
/// the drive has not; InputError if it has no scan, no images, or a table that cannot be read.
std::unique_ptr<FrameSource> open_generic_drive(const std::filesystem::path& path,
                                                const DriveOptions& options);

}  // namespace fovea
