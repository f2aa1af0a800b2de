// The map as a camera sees it: what new points would hide, and new colours for what is in view
// again (docs/method.md 5, 6).
#pragma once

#include "fovea/map/tile_map.h"
#include "fovea/mapping/depth_buffer.h"
#include "fovea/mapping/foveal_region.h"
#include "fovea/mapping/image_pyramid.h"

namespace fovea {

/// An image that colours points.
struct ColorView {
  const ImagePyramid& image;
  const Camera& camera;
  int frame = 0;
  double footprint = 0.02;  ///< m: edge of the patch of surface whose mean colour a point gets
  /// By which the image's colours are multiplied, a channel.
  Eigen::Array3f gain = Eigen::Array3f::Ones();
};

/// Whether an image's exposure is so far off the map's that its colours must not be mixed with
/// those of others: by over 40 %. What automatic exposure does from frame to frame is less.
bool is_exposure_off(const Eigen::Array3f& gain_to_map);

/// The gain under which such an image colours new points: nine tenths of the way to the map's
/// exposure, so that light that changes for good is followed within seconds.
Eigen::Array3f matching_gain(const Eigen::Array3f& gain_to_map);

/// Gives new points, all in view, the view's colours, as their first ones.
/// @param points_cam  camera frame; columns frame, camera and those of the colour are set, and
///                    `reason` is marked where a gain has matched the view's exposure
void colour_new_points(PointCloud& points_cam, const ColorView& view);

/// The points of a map in one camera's view, at one moment.
class SeenMap {
 public:
  /// @param region   what may be coloured; it knows the camera
  /// @param spacing  of the map's points, m
  SeenMap(const TileMap& map, const FovealRegion& region, const RigidMotion& T_cam_local,
          double spacing);

  /// Marks (1) points that stand before the map, where it has been seen already: something has come
  /// between. Along a ray what is near comes into the foveal region first, so that what stands
  /// still is in the map before its background is.
  std::vector<std::uint8_t> marks_before(const PointCloud& points_cam) const;

  /// The gain, a channel, that brings the view's colours to those of the map: the median over
  /// points of two views and more. 1 where too few tell.
  Eigen::Array3f gain_to_map(const TileMap& map, const ColorView& view) const;

  /// Fuses the view's colours into the points in the region that neither other points of the map
  /// nor new ones hide. To be called once.
  /// @param map             the same, not changed since
  /// @param new_points_cam  of the frame at hand, not in the map: they hide, too
  /// @return how many points were in view
  std::size_t recolour(TileMap& map, const ColorView& view, const PointCloud& new_points_cam);

 private:
  struct Point {
    std::uint32_t index;  // in its tile
    Eigen::Vector2f pixel;
    float depth, distance;  // m
    bool in_region;
  };
  struct Tile {
    TileId id;
    const PointCloud* points;
    std::vector<Point> seen;
  };
  void look_at(const TileMap& map, const RigidMotion& T_cam_local, Tile& tile) const;
  void put_in_front(const Eigen::Vector2f& pixel, float depth);

  const FovealRegion& region_;
  double spacing_;
  std::vector<Tile> tiles_;
  DepthBuffer front_;
};

}  // namespace fovea
