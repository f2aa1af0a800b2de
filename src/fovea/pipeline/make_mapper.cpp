#include "fovea/pipeline/make_mapper.h"

#include "fovea/pipeline/mapper.h"
#include "fovea/pipeline/paper_mapper.h"

namespace fovea {

std::unique_ptr<IncrementalMapper> make_mapper(const DriveInfo& drive, const MapSettings& settings,
                                               PoseSource pose_source, MapperServices services) {
  if (settings.is_paper()) {
    return std::make_unique<PaperMapper>(drive, settings.paper(), pose_source, std::move(services));
  }
  return std::make_unique<Mapper>(drive, settings.mapper(), pose_source, std::move(services));
}

}  // namespace fovea
