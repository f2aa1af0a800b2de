// The pixels of a camera that show no scene: the vehicle itself, or what must stay private.
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/core/image.h"

namespace fovea {

class ImageMask {
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
