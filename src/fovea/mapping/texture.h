// Texture (paper: Ray-filtering and Texture Mapping; docs/method.md 6): colour from one view.
#pragma once

#include "fovea/base/image.h"
#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"

namespace fovea {

/// How a colour is read between pixel centres.
enum class ImageSampling { kBilinear, kNearest };

/// Which views a point's colour is of.
enum class TextureViews {
  kFirst,  ///< the one that the point came with, as in the paper
  kMean,   ///< all that see it, fused (mapping/color_fusion.h)
};

struct TextureOptions {
  TextureViews views = TextureViews::kFirst;
  double footprint = 0.02;  ///< of kMean: edge of the patch whose mean colour a view gives (m)
  ImageSampling sampling = ImageSampling::kBilinear;  ///< of kFirst
  void validate() const;                              ///< ConfigError that names the field
};

/// Where a point's colour comes from.
struct View {
  const Image& image;
  const Camera& camera;
  int frame = 0;
};

/// Colours every point from the image at its projection and notes frame and camera;
/// points that do not project into the image, all if it is empty, get kNoCamera. One view, no
/// average: averaging blurs edges.
/// @param points_cam  camera frame, origin 0
void colour_points(PointCloud& points_cam, const View& view, const TextureOptions& options = {});

}  // namespace fovea
