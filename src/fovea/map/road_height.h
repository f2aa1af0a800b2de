// Heights above the road, which lies under the path of the vehicle.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/geometry/kd_tree.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// The road is the path of the LiDAR, lowered by the LiDAR's height.
///
///   const RoadHeight road(map);
///   if (road.above(p_local) < 2) keep(p_local);
///
/// The map states the height of each LiDAR. Where it does not, the points near the path give one
/// height for the map. Where they are too few, the height is kUsualSensorHeight.
class RoadHeight {
 public:
  /// InputError if the map is damaged.
  explicit RoadHeight(const MapReader& map);

  /// z minus that of the road at the place of the path that is nearest in plan, m. NaN in a map
  /// without frames that have a pose of their own.
  double above(const Eigen::Vector3d& p_local) const;

 private:
  struct Place {
    Eigen::Vector3d p_local;
    bool follows = false;  ///< the path leads here from the place before
  };
  /// The place between two neighbors that is nearest in plan.
  struct Nearest {
    double squared_distance, z;
  };

  /// Places at most kStep apart, up to this one.
  void lead_to(const Eigen::Vector3d& p_local, bool follows);
  void index_places();
  Nearest nearest_between(const Place& first, const Place& second,
                          const Eigen::Vector3d& p_local) const;
  /// Median height of the path above the points near it; the path is that of the LiDAR.
  double height_above_points(const MapReader& map) const;

  std::vector<Place> places_;
  std::vector<Eigen::Vector3f> in_plan_;  // relative to the first place, z = 0
  std::optional<KdTree> tree_;            // of in_plan_
};

}  // namespace fovea
