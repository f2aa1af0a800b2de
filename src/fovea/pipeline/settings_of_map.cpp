#include "fovea/pipeline/settings_of_map.h"

#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/config.h"

namespace fovea {

MapSettings settings_of_map(const MapMeta& meta, const std::string& map) {
  const auto stored = meta.find(meta_key::kConfig);
  if (stored == meta.end()) {
    throw meta.contains(meta_key::kRepair)
        ? InputError("the map was repaired and has lost its settings", map, "map the drive again")
        : InputError("the map does not tell its settings", map,
                     "give a map that 'fovea map' wrote");
  }
  return stored_settings(stored->second, map);
}

}  // namespace fovea
