// What the LiDAR saw around each submap: by the range images of a map, all round and farther than
// its points.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/core/scratch_file.h"
#include "fovea/map/map_surfaces.h"
#include "fovea/merging/map_content.h"

namespace fovea {

/// Of maps without range images these are the measured points. Memory does not grow with the map.
class SubmapScans {
 public:
  /// Reads the range images. InputError if the map is damaged.
  /// @param map, content  of one map; must outlive this
  SubmapScans(const MapReader& map, const MapContent& content);

  const std::vector<RigidMotion>& T_local_submap() const { return content_.T_local_submap; }

  /// The points in a ball, thinned to MapSurfaces::kVoxel.
  /// @param center_local  m, in the map's local frame
  /// @param submap        only those of this one
  /// @return in the axes of local, relative to the center
  std::vector<Eigen::Vector3f> points_near(const Eigen::Vector3d& center_local, double radius,
                                           std::optional<std::size_t> submap = {});

 private:
  /// Keeps the points of a submap, thinned, in the submap's frame.
  void keep(std::size_t submap, std::vector<Eigen::Vector3f> points);

  const MapContent& content_;
  std::optional<MapSurfaces> surfaces_;                    // without range images
  std::vector<std::optional<ScratchFile::Place>> points_;  // by submap
  ScratchFile file_;
};

}  // namespace fovea
