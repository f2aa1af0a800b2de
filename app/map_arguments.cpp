#include "app/map_arguments.h"

#include "fovea/base/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/config.h"

namespace fovea::app {

MapperOptions stored_options(const MapMeta& meta, const std::string& map) {
  const auto stored = meta.find(meta_key::kConfig);
  if (stored == meta.end()) {
    throw InputError("the map does not tell its settings", map,
                     "give a map that 'fovea map' wrote");
  }
  MapperOptions options;
  apply_config_text(stored->second, map, options);
  return options;
}

}  // namespace fovea::app
