// Color from one view (paper: Ray-filtering and Texture Mapping; docs/method.md 6).
#pragma once

#include "fovea/camera.h"
#include "fovea/image.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Interpolation between pixel centers.
enum class ImageSampling { kBilinear, kNearest };

/// An image and its camera.
struct View {
  const Image& image;
  const Camera& camera;
  int frame = 0;
  const ImageMask* mask = nullptr;  ///< absent: every pixel shows the scene
};

/// Colors each point from the image at its projection, and sets frame and camera. Points outside
/// the image or in its mask get kNoCamera; so do all points if the image is empty. Averaging views
/// would blur edges.
/// @param points_cam  camera frame, origin 0
FOVEA_API void color_points(PointCloud& points_cam, const View& view,
                            ImageSampling sampling = ImageSampling::kBilinear);

}  // namespace fovea
