// An image at halved resolutions: colours of patches, not of points (Williams 1983).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/color_block.h"
#include "fovea/base/image.h"

namespace fovea {

class ImagePyramid {
 public:
  explicit ImagePyramid(const Image& image);

  /// Mean colours (0-255 a channel) of about `footprint` x `footprint` pixels around (u, v), linear
  /// between levels; bilinear in the image itself where the footprint is 1 or less.
  /// @param u, v, footprint  pixels, of one length, at most that of a block
  void colors_at(std::span<const float> u, std::span<const float> v,
                 std::span<const float> footprint, ColorBlock& colors) const;

 private:
  static constexpr int kLevels = 6;  // the last one's pixels are 32 pixels wide
  void take_in(const Image& image);
  void halve(int level);
  void repeat_last(int level);
  std::uint32_t* row(int level, int y) {
    return pixels_.data() + first_[std::size_t(level)] + y * ((width_ >> level) + 1);
  }
  /// @param level  of each point
  void bilinear_at(std::span<const float> u, std::span<const float> v,
                   std::span<const std::int32_t> level, ColorBlock& colors) const;

  int width_, height_;  // of level 0; those of level k are halved k times, rounded down
  float coarsest_ = 1;  // footprint of the last level's pixels
  /// Of each level in pixels_; one more, which is never weighed, for the last to have a next.
  std::array<std::int32_t, kLevels + 1> first_{};
  /// Four bytes each, red lowest. A level has one column and one row more that repeat the last: the
  /// pixels to the right and below are always there.
  std::vector<std::uint32_t> pixels_;
};

}  // namespace fovea
