// The mapper that settings ask for.
#pragma once

#include <memory>

#include "fovea/pipeline/incremental_mapper.h"
#include "fovea/pipeline/map_settings.h"

namespace fovea {

/// A Mapper or a PaperMapper.
/// @param drive  must outlive the mapper
std::unique_ptr<IncrementalMapper> make_mapper(const DriveInfo& drive, const MapSettings& settings,
                                               PoseSource pose_source, MapperServices services);

}  // namespace fovea
