// The file of the poses of a city: the output of fovea adjust (docs/city.md).
#pragma once

#include <filesystem>

#include "fovea/merging/city_poses.h"

namespace fovea {

/// @throws OutputError  as OutputFile
void write_city_poses(const CityPoses& city, const std::filesystem::path& path, bool force);

/// @throws InputError  if the file is missing, damaged or of another kind
CityPoses read_city_poses(const std::filesystem::path& path);

}  // namespace fovea
