// Images from files: depth maps, and the limit of read_image() (fovea/image.h).
#pragma once

#include <filesystem>
#include <vector>

#include "fovea/image.h"

namespace fovea {

/// Largest width or height that is believed (pixels). A damaged header must not ask for gigabytes.
inline constexpr unsigned kMaxImageSide = 8'192;

/// Distance of what each pixel shows.
struct DepthImage {
  int width = 0, height = 0;
  std::vector<float>
      depth;  ///< m along the optical axis at the pixels' centres, by rows; 0: nothing

  float at(int x, int y) const { return depth[static_cast<std::size_t>(y) * width + x]; }
};

/// Reads a depth map in KITTI's form: a PNG of one 16-bit channel, depth x 256, 0 where there is
/// none. InputError with the file's name for anything else.
DepthImage read_depth_image(const std::filesystem::path& file);

}  // namespace fovea
