// Images and colors. Integer pixel coordinates are pixel CENTERS, everywhere (OpenCV, KITTI).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Nearest 8-bit color of a float color (0-255 a channel, clamped).
FOVEA_API Rgb to_rgb(const Eigen::Vector3f& color);
inline Eigen::Vector3f to_float(Rgb c) { return {float(c.r), float(c.g), float(c.b)}; }

/// Brightness of a color (ITU-R BT.601), 0-255; the common value of the channels of a gray one.
inline float luma(const Eigen::Vector3f& color) {
  return color.dot(Eigen::Vector3f(0.299f, 0.587f, 0.114f));
}

/// 8-bit image, rows from the top, channels interleaved; 1 (gray) or 3 (RGB) channels.
struct FOVEA_API Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint8_t> data;  // height * width * channels

  Image() = default;
  Image(int width, int height, int channels);

  bool empty() const { return data.empty(); }
  const std::uint8_t* pixel(int x, int y) const {
    return data.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
  std::uint8_t* pixel(int x, int y) {
    return data.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
};

/// Reads an 8-bit gray or RGB image, PNG or JPEG; the content states which, not the name.
/// InputError if it is neither, damaged, truncated, of 16 bits, or wider or higher than 8192
/// pixels.
FOVEA_API Image read_image(const std::filesystem::path& file);

/// The same of the bytes of a file.
/// @param name  stands for the file in errors
FOVEA_API Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name);

/// Color at sub-pixel position (u, v), bilinear between the four pixel centers around it;
/// coordinates are clamped to the image. A gray image gives three equal channels (0-255).
FOVEA_API Eigen::Vector3f bilinear(const Image& image, double u, double v);

/// The pixels of a camera that show no scene: the vehicle itself, or what must stay private.
///
///   const ImageMask mask(picture);
///   color_points(points_cam, {image, camera, frame, &mask});
class FOVEA_API ImageMask {
 public:
  /// @param picture  of the camera's size; dark pixels (below 128 in any channel) are masked
  explicit ImageMask(const Image& picture);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Whether a pixel within a square is masked. What lies outside the image is not.
  /// @param u, v, half  its center and half its edge, pixels
  bool covers(float u, float v, float half) const;

  /// The same for equal masks, and for others hardly ever.
  std::uint32_t fingerprint() const;

 private:
  std::uint32_t& masked_before(int x, int y) { return masked_before_[place(x, y)]; }
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) +
           static_cast<std::size_t>(x);
  }

  int width_, height_;
  std::vector<std::uint32_t> masked_before_;  // masked pixels above and to the left of each corner
};

}  // namespace fovea
