// The file of a pair of maps: the output of fovea align (docs/city.md).
#pragma once

#include <filesystem>

#include "fovea/merging/map_pair.h"

namespace fovea {

/// @throws OutputError  as OutputFile
void write_pair(const MapPair& pair, const std::filesystem::path& path, bool force);

/// @throws InputError  if the file is missing, damaged or of another kind
MapPair read_pair(const std::filesystem::path& path);

}  // namespace fovea
