// The colors that one image gives to points (docs/method.md 6): means over the surface patches of
// the points, with a weight for each point.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "fovea/camera.h"
#include "fovea/core/view_light.h"
#include "fovea/image.h"
#include "fovea/mapping/color_fusion.h"
#include "fovea/mapping/depth_buffer.h"
#include "fovea/mapping/image_pyramid.h"
#include "fovea/mapping/projected_points.h"
#include "fovea/mapping/radiometry.h"

namespace fovea {

/// Weight of a view: the inverse of its distance (m), since a near view shows more detail. An
/// integer from 1 to 1600, so that sums are exact.
std::uint16_t view_weight(float distance);

class ViewColors {
 public:
  using Samples = std::array<ColorSample, ProjectedPoints::kSize>;

  /// @param image      must outlive the object
  /// @param footprint  edge of the surface patch whose mean color a point gets, m
  /// @param mask       must outlive the object; nullptr: every pixel shows the scene
  ViewColors(const ImagePyramid& image, const Camera& camera, double footprint,
             const ImageMask* mask = nullptr);

  /// The same colors, brought to the exposure of the map, without vignetting.
  ViewColors in_light(const ViewLight& light) const;

  /// Samples of the first `count` points. Saturated and noisy values get a small weight, and what
  /// the mask covers none.
  void sample(const ProjectedPoints& points, std::size_t count, Samples& samples) const;

  const CameraResponse& response() const { return light_.response; }

 private:
  const ImagePyramid& image_;
  float footprint_;  // pixels at a depth of 1 m
  float fx_, fy_, cx_, cy_;
  float s_per_pixel_;  // squared_distance_from_center() for one pixel
  const ImageMask* mask_;
  ViewLight light_;
};

/// The colors of points from their first view; none of what a mask covers.
/// @param points_cam   camera frame, all in view
/// @param depth        of the view, with its edges; nullptr: unknown
/// @param submap_gain  as below
std::vector<FusedColor> first_colors(std::span<const Eigen::Vector3f> points_cam,
                                     const ViewColors& view, const Camera& camera,
                                     const DepthBuffer* depth, const LogGain& submap_gain);

/// Colors new points, all in view, from their first view. Those that a mask covers get no color.
/// @param points_cam   camera frame. Sets frame, camera and the columns of the color
/// @param depth        as above
/// @param submap_gain  of their submap: base-2 logarithms, from its colors to the exposure of the
///                     map
void color_new_points(PointCloud& points_cam, const ViewColors& view, const Camera& camera,
                      const DepthBuffer* depth, int frame, const LogGain& submap_gain);

}  // namespace fovea
