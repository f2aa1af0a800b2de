#include "fovea/map/map_format.h"

#include "fovea/map/map_format_6.h"

namespace fovea {

const MapFormat& current_format() {
  static const MapFormat format{kMapFormatVersion, /*has_checksums=*/true, kTileFormat, select_sql,
                                [](MapMeta stored) { return stored; }};
  return format;
}

const MapFormat* find_format(std::int64_t version) {
  for (const MapFormat* format : {&current_format(), &format_6()}) {
    if (format->version == version) return format;
  }
  return nullptr;
}

}  // namespace fovea
