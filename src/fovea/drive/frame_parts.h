// Steps from the parts of a frame to the frame, for drives from files and from memory.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "fovea/drive/frame_source.h"
#include "fovea/drive/images/image_rectifier.h"

namespace fovea {

/// Gives the points of one LiDAR among several their times from the scan's stamp: 0 if the sweep is
/// compensated, and those of the sweep if they have none.
void set_point_times(PointCloud& scan, bool is_compensated, const SweepTiming& sweep);

/// Reads the image of a camera, checks its size and rectifies it.
/// @param rectifier  nullptr: images are rectified already
/// @param name       of the image, for messages
/// @param read       throws InputError for a damaged image
/// @return why `image` stays empty, if the image cannot be used
std::optional<MissingImage> load_image(const Camera& camera, const ImageRectifier* rectifier,
                                       const std::string& name, const std::function<Image()>& read,
                                       Image& image);

/// A frame of which no camera has an image.
SkippedFrame frame_without_images(const Frame& frame);

}  // namespace fovea
