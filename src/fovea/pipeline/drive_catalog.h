// What a planner of many drives needs of one: its identity, its length, where it goes.
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/map/map_records.h"

namespace fovea {

/// A place on the way.
struct CatalogPlace {
  int frame = 0;
  double along = 0;  ///< m of way from the first frame
  GeodeticPoint position;
};

struct DriveCatalog : Messages {
  DriveRecord drive;
  CoordinateReference coordinates;  ///< as the drive states them
  std::filesystem::path path;
  std::size_t frames = 0;
  double duration = 0;             ///< s, from the first to the last stamp
  double length = 0;               ///< m, by navigation
  std::optional<double> accuracy;  ///< m, median of what navigation states; absent if it does not
  /// By navigation, every 5 m, and the last one. Empty without georeference.
  std::vector<CatalogPlace> places;
};

/// Reads navigation and stamps, and no scan.
DriveCatalog catalog_of(const FrameSource& source);

/// The file of `fovea catalog` (docs/city.md).
std::string to_json(const DriveCatalog& catalog);

}  // namespace fovea
