// Shows new images to the map: colours of points that are in view again get better (docs/method.md
// 6).
#pragma once

#include "fovea/map/tile_map.h"
#include "fovea/mapping/foveal_region.h"
#include "fovea/mapping/image_pyramid.h"

namespace fovea {

/// An image that colours points, and where it was taken.
struct MapView {
  const ImagePyramid& image;
  const FovealRegion& region;  ///< what may be coloured; it knows the camera
  RigidMotion T_cam_local;
  int frame = 0;
  double footprint = 0.02;  ///< m: edge of the patch of surface whose mean colour a point gets
};

/// Gives new points, all in view, the view's colours, as their first ones.
/// @param points_cam  camera frame; columns frame, camera and those of the colour are set
void colour_new_points(PointCloud& points_cam, const MapView& view);

/// Fuses the view's colours into the points of the map that are in its region, and that neither
/// other points of the map nor new ones hide.
/// @param new_points_cam  of the frame at hand, not in the map yet: they hide, too
/// @return how many points were in view
std::size_t recolour(TileMap& map, const MapView& view, const PointCloud& new_points_cam,
                     const Eigen::Vector3d& center_local);

}  // namespace fovea
