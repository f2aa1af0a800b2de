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

/// Colors each point from the image at its projection: sets the columns color, camera and frame.
/// Points behind the camera, outside the image or in its mask get kNoCamera; so do all points if
/// the image is empty. A point that another one hides gets the color of the other: see
/// ray_filter.h.
///
///   PointCloud points_cam;
///   for (const Eigen::Vector3d& p_lidar : mine) {
///     points_cam.position.push_back((camera.T_cam_lidar * p_lidar).cast<float>());
///   }
///   color_points(points_cam, {read_image("000017.png"), camera});
///
/// @param points_cam  camera frame, origin 0
/// @throws std::invalid_argument  if image or mask and camera differ in size, the image's data is
/// not
///                                as long as its size states, or the camera has no focal length or
///                                a number beyond 0 to 127
FOVEA_API void color_points(PointCloud& points_cam, const View& view,
                            ImageSampling sampling = ImageSampling::kBilinear);

}  // namespace fovea
