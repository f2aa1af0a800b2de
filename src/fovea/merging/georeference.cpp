#include "fovea/merging/georeference.h"

#include <fmt/format.h>

#include "fovea/errors.h"
#include "fovea/map/map_meta.h"

namespace fovea {
namespace {

const std::string& drive_name(const MapContent& map) { return map.drives.front().name; }

}  // namespace

GeodeticPoint origin_of(const MapContent& map) {
  const auto origin = map_origin(map.meta);
  if (origin) return *origin;
  throw InputError("a map without georeference is no part of a city", drive_name(map),
                   "map the drive with GPS/INS, or give it its origin (docs/drives.md)");
}

void state_coordinates(const CoordinateReference& stated, MapContent& map) {
  DriveRecord& drive = map.records.front();
  // What a drive has that states nothing (pipeline/drive_records.h).
  if (drive.datum.value_or(kWgs84) != kWgs84 || drive.epoch_year) return;
  if (drive.height_type.value_or(HeightType::kEllipsoidal) != HeightType::kEllipsoidal) return;
  if (stated.datum) drive.datum = stated.datum;
  if (stated.epoch_year) drive.epoch_year = stated.epoch_year;
  if (stated.heights) drive.height_type = stated.heights;
}

void require_same_coordinates(const MapContent& a, const MapContent& b) {
  const DriveRecord &first = a.records.front(), &other = b.records.front();
  const auto refuse = [&](const char* what) {
    throw InputError(fmt::format("{} and {} have another {}", drive_name(a), drive_name(b), what),
                     drive_name(b),
                     "state it in both drives, or for all others with --datum, --epoch and "
                     "--heights, and convert "
                     "the coordinates of one of them");
  };
  if (first.datum != other.datum) refuse("datum");
  if (first.epoch_year != other.epoch_year) refuse("epoch of the datum");
  if (first.height_type != other.height_type) refuse("type of heights");
}

void require_ellipsoidal_wgs84(const MapContent& map) {
  const DriveRecord& drive = map.records.front();
  const bool is_wgs84 = drive.datum.value_or(kWgs84) == kWgs84;
  const bool is_ellipsoidal =
      drive.height_type.value_or(HeightType::kEllipsoidal) == HeightType::kEllipsoidal;
  if (is_wgs84 && is_ellipsoidal) return;
  throw InputError("surveyed points need drives in WGS 84 with heights above the ellipsoid",
                   drive_name(map), "convert the coordinates of the drives");
}

}  // namespace fovea
