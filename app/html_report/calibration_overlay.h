// The LiDAR's points on the photographs, before and after a calibration.
#pragma once

#include <string>
#include <vector>

#include "fovea/pipeline/drive_calibration.h"

namespace fovea::app {

/// A part of an image, in pixels.
struct ImageWindow {
  int left = 0, top = 0, width = 0, height = 0;
};

/// The window with the most edges. Empty (width 0) without edges.
/// @param window  its size; at most that of the image
ImageWindow window_with_most_edges(const Image& image, const std::vector<OverlayPoint>& points,
                                   ImageWindow window);

/// A part of an image in dimmed colors, with the points in it. Near points are red, far points are
/// blue, edges are white and larger. A point that is not finite or outside is not drawn.
/// @param scale  pixels of the picture for each pixel of the image
Image picture_with_points(const Image& image, const std::vector<OverlayPoint>& points,
                          const ImageWindow& window, double scale);

/// Each overlay as a picture before and a picture after, under a slider, with close-ups. Explains
/// the colors. States that there are none if there are none.
std::string overlay_section(const std::vector<CameraCalibration>& cameras);

}  // namespace fovea::app
