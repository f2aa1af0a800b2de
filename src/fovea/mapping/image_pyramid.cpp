#include "fovea/mapping/image_pyramid.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr std::size_t kRowGrain = 64;

/// Mean of 2 x 2 pixels, rounded half up; two channels at a time.
std::uint32_t mean_of_four(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  constexpr std::uint32_t kBytes = 0x00ff00ff, kHalf = 0x00020002;
  const auto mean = [](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
    return (((p & kBytes) + (q & kBytes) + (r & kBytes) + (s & kBytes) + kHalf) >> 2) & kBytes;
  };
  return mean(a, b, c, d) | mean(a >> 8, b >> 8, c >> 8, d >> 8) << 8;
}

}  // namespace

ImagePyramid::ImagePyramid(const Image& image) : width_(image.width), height_(image.height) {
  int size = 0, levels = 0;
  for (int level = 0; level <= kLevels; ++level) {
    first_[std::size_t(level)] = size;
    if (level < kLevels && std::min(width_ >> level, height_ >> level) > 0) levels = level + 1;
    // One more row and column, including the level of weight 0, which is read too.
    size += ((width_ >> level) + 2) * ((height_ >> level) + 2);
  }
  pixels_.resize(static_cast<std::size_t>(size));
  coarsest_ = static_cast<float>(1 << (levels - 1));
  pack(image);
  for (int level = 1; level < levels; ++level) halve(level);
}

void ImagePyramid::pack(const Image& image) {
  const int green = image.channels == 3 ? 1 : 0, blue = image.channels == 3 ? 2 : 0;
  parallel_for(static_cast<std::size_t>(height_), kRowGrain, [&](std::size_t i) {
    const int y = static_cast<int>(i);
    const std::uint8_t* from = image.pixel(0, y);
    std::uint32_t* const to = row(0, y);
    for (int x = 0; x < width_; ++x, from += image.channels) {
      to[x] = from[0] | static_cast<std::uint32_t>(from[green]) << 8 |
              static_cast<std::uint32_t>(from[blue]) << 16;
    }
  });
  repeat_last(0);
}

void ImagePyramid::halve(int level) {
  const int width = width_ >> level;
  parallel_for(static_cast<std::size_t>(height_ >> level), kRowGrain, [&](std::size_t i) {
    const int y = static_cast<int>(i);
    const std::uint32_t *above = row(level - 1, 2 * y), *below = row(level - 1, 2 * y + 1);
    std::uint32_t* const to = row(level, y);
    const int columns = width;  // a local copy cannot alias the output
    for (int x = 0; x < columns; ++x) {
      to[x] = mean_of_four(above[2 * x], above[2 * x + 1], below[2 * x], below[2 * x + 1]);
    }
  });
  repeat_last(level);
}

void ImagePyramid::repeat_last(int level) {
  const int width = width_ >> level, height = height_ >> level;
  for (int y = 0; y < height; ++y) row(level, y)[width] = row(level, y)[width - 1];
  std::copy_n(row(level, height - 1), width + 1, row(level, height));
}

void ImagePyramid::bilinear_at(std::span<const float> u, std::span<const float> v,
                               std::span<const std::int32_t> level, ColorBlock& colors) const {
  const std::size_t n = u.size();
  const std::int32_t width = width_, height = height_;
  std::array<std::int32_t, ColorBlock::kSize> index, stride;
  std::array<float, ColorBlock::kSize> right, down;  // weights of the pixels there
  for (std::size_t i = 0; i < n; ++i) {
    const std::int32_t columns = width >> level[i], rows = height >> level[i];
    const auto scale = std::bit_cast<float>((127 - level[i]) << 23);  // 2^-level
    const float x = (u[i] + 0.5f) * scale - 0.5f, y = (v[i] + 0.5f) * scale - 0.5f;
    const float inner_x = std::max(std::min(x, static_cast<float>(columns - 1)), 0.0f);
    const float inner_y = std::max(std::min(y, static_cast<float>(rows - 1)), 0.0f);
    const auto column = static_cast<std::int32_t>(inner_x);
    const auto line = static_cast<std::int32_t>(inner_y);
    stride[i] = columns + 1;
    index[i] = line * (columns + 1) + column;
    right[i] = inner_x - static_cast<float>(column);
    down[i] = inner_y - static_cast<float>(line);
  }
  // Random access to memory in a loop of its own.
  using Pair = std::array<std::uint32_t, 2>;
  std::array<Pair, ColorBlock::kSize> above, below;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t* const pixel = pixels_.data() + first_[std::size_t(level[i])] + index[i];
    std::memcpy(&above[i], pixel, sizeof(Pair));
    std::memcpy(&below[i], pixel + stride[i], sizeof(Pair));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto mixed = [&](int shift) {
      const auto byte = [&](std::uint32_t pixel) {
        return static_cast<float>(static_cast<std::int32_t>(pixel >> shift & 0xff));
      };
      const float top = byte(above[i][0]) + right[i] * (byte(above[i][1]) - byte(above[i][0]));
      const float bottom = byte(below[i][0]) + right[i] * (byte(below[i][1]) - byte(below[i][0]));
      return top + down[i] * (bottom - top);
    };
    colors.red[i] = mixed(0);
    colors.green[i] = mixed(8);
    colors.blue[i] = mixed(16);
  }
}

void ImagePyramid::colors_at(std::span<const float> u, std::span<const float> v,
                             std::span<const float> footprint, ColorBlock& colors) const {
  const std::size_t n = u.size();
  const float coarsest = coarsest_;
  std::array<std::int32_t, ColorBlock::kSize> level;
  std::array<float, ColorBlock::kSize> share;
  for (std::size_t i = 0; i < n; ++i) {
    // Base-2 logarithm of the footprint: the exponent is the level; a parabola approximates the
    // logarithm of the mantissa to within a hundredth of a level.
    const float clamped = std::min(std::max(footprint[i], 1.0f), coarsest);
    const auto bits = std::bit_cast<std::int32_t>(clamped);
    level[i] = (bits >> 23) - 127;
    const auto mantissa = std::bit_cast<float>((bits & 0x7fffff) | 0x3f800000);
    share[i] = (mantissa - 1) * (5 - mantissa) * (1.0f / 3);
  }
  ColorBlock coarse;
  bilinear_at(u, v, {level.data(), n}, colors);
  for (std::size_t i = 0; i < n; ++i) ++level[i];
  bilinear_at(u, v, {level.data(), n}, coarse);
  for (std::size_t i = 0; i < n; ++i) {
    colors.red[i] += share[i] * (coarse.red[i] - colors.red[i]);
    colors.green[i] += share[i] * (coarse.green[i] - colors.green[i]);
    colors.blue[i] += share[i] * (coarse.blue[i] - colors.blue[i]);
  }
}

}  // namespace fovea
