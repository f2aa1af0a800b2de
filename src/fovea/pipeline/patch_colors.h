// Colors of points in one image: means over the surface patches of the points.
#pragma once

#include "fovea/core/point_cloud.h"
#include "fovea/geometry/camera.h"
#include "fovea/mapping/image_pyramid.h"
#include "fovea/mapping/projected_points.h"

namespace fovea {

/// An image that colors points.
struct ColorView {
  const ImagePyramid& image;
  const Camera& camera;
  int frame = 0;
  double footprint = 0.02;  ///< m: edge of the surface patch whose mean color a point gets
  /// Factor of each channel that matches the image to the map's exposure.
  Eigen::Array3f gain = Eigen::Array3f::Ones();
  bool has_gain() const { return (gain != 1).any(); }
};

class PatchColors {
 public:
  explicit PatchColors(const ColorView& view)
      : image_(view.image),
        gain_(view.gain),
        footprint_(static_cast<float>(view.footprint * view.camera.fx)) {}

  /// Colors of the first `count` points.
  void at(const ProjectedPoints& points, std::size_t count, ColorBlock& colors) const {
    std::array<float, ColorBlock::kSize> footprint;
    for (std::size_t i = 0; i < count; ++i) footprint[i] = footprint_ / points.depth[i];
    image_.colors_at({points.u.data(), count}, {points.v.data(), count}, {footprint.data(), count},
                     colors);
    for (std::size_t i = 0; i < count; ++i) {
      colors.red[i] *= gain_.x();
      colors.green[i] *= gain_.y();
      colors.blue[i] *= gain_.z();
    }
  }

 private:
  const ImagePyramid& image_;
  Eigen::Array3f gain_;
  float footprint_;  // pixels at a depth of 1 m
};

/// Colors new points, all in view, from their first view.
/// @param points_cam  camera frame. Sets frame, camera and the columns of the color. Marks `reason`
///                    if the view has a gain.
void color_new_points(PointCloud& points_cam, const ColorView& view);

}  // namespace fovea
