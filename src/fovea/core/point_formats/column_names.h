// Names of columns: other programs spell the same column differently.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fovea {

/// The name in lower case, without signs and without the prefix "scalar_" of CloudCompare:
/// "time_stamp", "Time Stamp" and "scalar_TimeStamp" are the same.
std::string plain_column_name(std::string_view name);

/// Place of a column in a file: the column of that name, or else the one with another usual name.
/// "intensity" is also "Intensity", "intensities", "i" and "reflectivity"; "time" is also "t",
/// "timestamp" and "offset_time", with a unit behind it or without.
/// @param names   of the columns in the file
/// @param wanted  name that the reader uses
std::optional<std::size_t> find_column(std::span<const std::string> names, std::string_view wanted);

/// The first names, for a message.
std::string list_columns(std::span<const std::string> names);

}  // namespace fovea
