#include "fovea/mapping/blank_image.h"

#include <algorithm>

namespace fovea {
namespace {
constexpr int kStep = 8;
constexpr int kBlack = 5, kWhite = 250;  // gray values, of every channel
}  // namespace

bool is_blank(const Image& image) {
  int tested = 0, black = 0, white = 0;
  for (int y = kStep / 2 % std::max(image.height, 1); y < image.height; y += kStep) {
    for (int x = kStep / 2 % std::max(image.width, 1); x < image.width; x += kStep) {
      const std::uint8_t* pixel = image.pixel(x, y);
      const auto [darkest, brightest] = std::minmax_element(pixel, pixel + image.channels);
      ++tested;
      black += *brightest <= kBlack;
      white += *darkest >= kWhite;
    }
  }
  return 100 * black >= 99 * tested || 100 * white >= 99 * tested;
}

}  // namespace fovea
