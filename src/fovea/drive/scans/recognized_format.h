// Recognizes units and columns of scans by the numbers of the first ones.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fovea/drive/scans/scan_format.h"
#include "fovea/drive/scans/scan_numbers.h"

namespace fovea {

struct FormatNote {
  std::string what;
  std::string keys;  ///< of drive.toml's [lidar], which change it; may be empty
};

struct RecognizedFormat {
  ScanFormat format;
  std::vector<FormatNote> notes;  ///< what is not as usual and not stated
};

/// The format of all scans of a drive. Used for drives and for recordings alike.
/// ConfigError whose place is the key of drive.toml, for numbers that have no meaning or several,
/// and for a stated value that cannot be right.
/// @param scans  the first ones of the drive; may be empty
RecognizedFormat recognize_format(std::span<const ScanNumbers> scans,
                                  const StatedScanFormat& stated);

/// The same for a drive with this drive.toml, which notes and errors name.
/// @param table  of the LiDAR: "lidar" or "lidar.NAME"
ScanFormat recognize_format_of_drive(std::span<const ScanNumbers> scans,
                                     const StatedScanFormat& stated,
                                     const std::filesystem::path& toml, const std::string& table,
                                     std::vector<std::string>& notes);

}  // namespace fovea
