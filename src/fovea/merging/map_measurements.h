// What a map alone says of the poses of its submaps, for a pose graph over many maps.
#pragma once

#include "fovea/mapping/fusion/pose_graph.h"
#include "fovea/merging/map_content.h"

namespace fovea {

/// Adds odometry from submap to submap, loops, and navigation with its stated accuracy.
/// @param first         node of the map's first submap
/// @param T_city_local  from the map's local frame to that of the graph, by its georeference
void add_map_measurements(const MapContent& map, std::size_t first, const RigidMotion& T_city_local,
                          PoseGraph& graph);

}  // namespace fovea
