#include "fovea/map/checked_map.h"

namespace fovea {

MapReader open_checked_map(const std::filesystem::path& map) {
  MapReader reader(map);
  reader.check_structure();
  reader.check_records();
  return reader;
}

}  // namespace fovea
