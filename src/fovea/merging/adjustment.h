// Adjusts the poses and gains of the submaps of many maps to each other.
#pragma once

#include <optional>
#include <vector>

#include "fovea/merging/city_poses.h"
#include "fovea/merging/control_points.h"

namespace fovea {

/// What the adjustment needs of a map: no points.
struct AdjustedMap {
  MapName name;
  MapContent content;
};

struct AdjustmentJob {
  std::vector<AdjustedMap> maps;
  std::vector<MapPair> pairs;  ///< of these maps
  std::vector<SurveyedPoint> points;
  /// Poses of some of the maps that stay as they are, and the origin that came with them.
  std::vector<PlacedMap> fixed;
  std::optional<GeodeticPoint> origin = {};  ///< absent: that of the first map
};

/// Solves one robust pose graph over all submaps: odometry and loops within the maps, matches
/// between them, navigation, control points. Then the gains of all submaps. Matches that contradict
/// the rest are left out and named. The result does not depend on the number of threads.
/// @throws InputError  if a map has no georeference, is given twice or has other coordinates than
///                     the first one, or if a pair, a point or fixed poses are of none of the maps
CityPoses adjust_city(const AdjustmentJob& job);

}  // namespace fovea
