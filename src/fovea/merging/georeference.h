// The coordinates of maps: all maps of a city must have the same.
#pragma once

#include <string>

#include "fovea/merging/map_content.h"

namespace fovea {

/// InputError for a map without georeference.
GeodeticPoint origin_of(const MapContent& map);

/// Applies what the user states to a map whose drive states no coordinates. Of others nothing
/// changes.
void state_coordinates(const CoordinateReference& stated, MapContent& map);

/// InputError if datum, epoch or type of heights of two maps differ, or are stated by one of them
/// alone: ITRF and ETRS89 are 0.8 m apart, geoid and ellipsoid up to 100 m.
void require_same_coordinates(const MapContent& a, const MapContent& b);

/// InputError if the heights of a map are not above the ellipsoid of WGS 84, which those of
/// surveyed points are.
void require_ellipsoidal_wgs84(const MapContent& map);

}  // namespace fovea
