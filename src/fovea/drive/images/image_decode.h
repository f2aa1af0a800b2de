// Images from files, PNG or JPEG.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fovea/image.h"

namespace fovea {

/// Largest width or height that is believed (pixels). A damaged header must not ask for gigabytes.
inline constexpr unsigned kMaxImageSide = 8'192;

/// Reads an 8-bit grey or RGB image; PNG and JPEG are told apart by their content, not by the name.
/// InputError with the file's name if it is neither, damaged, truncated, of 16 bits or absurdly
/// large.
Image read_image(const std::filesystem::path& file);

/// The same of a file's bytes; `name` stands for the file in errors.
Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name);

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
