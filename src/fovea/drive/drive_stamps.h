// Tables of stamps: index and time of the files next to them.
#pragma once

#include <filesystem>
#include <map>

#include "fovea/core/messages.h"
#include "fovea/drive/nearest_images.h"

namespace fovea {

/// A number of a scan or image is below: a day at 10 Hz.
inline constexpr int kMaxFileNumber = 1'000'000;

/// Stamps of scans. Notes the unit where it is not ns. Warns of lines that cannot be used.
/// InputError for a table that cannot be read, or whose stamps are no scans'.
NumberedTimes read_scan_stamps(const std::filesystem::path& file, Messages& messages);

/// The same of images.
/// @param scans  stamps of the scans, whose clock the images have; not empty
NumberedTimes read_image_stamps(const std::filesystem::path& file, const NumberedTimes& scans,
                                Messages& messages);

/// Exposure time times amplification of images by their numbers, base-2 logarithms: columns
/// exposure_s and gain_db of the table of stamps. Empty if it has neither. Warns of lines that
/// cannot be used.
std::map<int, double> read_image_exposures(const std::filesystem::path& file, Messages& messages);

}  // namespace fovea
