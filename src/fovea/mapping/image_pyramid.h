// Image pyramid: mean colors of patches (Williams 1983).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/core/color_block.h"
#include "fovea/image.h"

namespace fovea {

class ImagePyramid {
 public:
  explicit ImagePyramid(const Image& image);

  /// Mean colors (0-255 a channel) of about `footprint` x `footprint` pixels around (u, v), linear
  /// between levels. A footprint of at most 1 gives bilinear interpolation.
  /// @param u, v, footprint  pixels; equal lengths, at most that of a block
  void colors_at(std::span<const float> u, std::span<const float> v,
                 std::span<const float> footprint, ColorBlock& colors) const;

 private:
  static constexpr int kLevels = 6;  // a pixel of the last one is 32 pixels wide
  void pack(const Image& image);
  void halve(int level);
  void repeat_last(int level);
  std::uint32_t* row(int level, int y) {
    return pixels_.data() + first_[std::size_t(level)] + y * ((width_ >> level) + 1);
  }
  /// @param level  of each point
  void bilinear_at(std::span<const float> u, std::span<const float> v,
                   std::span<const std::int32_t> level, ColorBlock& colors) const;

  int width_, height_;  // of level 0; level k halves them k times, rounded down
  float coarsest_ = 1;  // footprint of the last level's pixels
  /// Start of each level in pixels_. One more level of weight 0 follows the last.
  std::array<std::int32_t, kLevels + 1> first_{};
  /// Four bytes each, red lowest. Each level repeats its last column and row, so that pixels to the
  /// right and below always exist.
  std::vector<std::uint32_t> pixels_;
};

}  // namespace fovea
