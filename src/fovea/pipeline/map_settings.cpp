#include "fovea/pipeline/map_settings.h"

namespace fovea {

MapSettings with_variant(std::string_view name, const MapSettings& settings) {
  PaperOptions options = settings.is_paper() ? settings.paper() : PaperOptions();
  apply_variant(name, options);
  MapSettings result(options);
  result.run.max_damaged_share = settings.run.max_damaged_share;
  return result;
}

}  // namespace fovea
