#include "fovea/drive/images/png_unfilter.h"

#include <array>
#include <cstring>

namespace fovea {
namespace {

using Byte = std::uint8_t;

/// Adds predict(left, above) to each byte. The pixel on the left stays in registers: its way
/// through memory would be the longest link of the chain that a row is.
template <int kBytes, class Predict>
void undo(Byte* __restrict row, std::size_t bytes, const Byte* __restrict above, Predict predict) {
  std::array<int, kBytes> left{};
  for (std::size_t i = 0; i < bytes; i += kBytes) {
    for (std::size_t c = 0; c < kBytes; ++c) {
      row[i + c] = static_cast<Byte>(row[i + c] + predict(left[c], int{above[i + c]}));
      left[c] = row[i + c];
    }
  }
}

/// The samples of a pixel in one register, for Paeth's filter: twice as fast as sample by sample,
/// and no branch depends on noise. (For the simpler filters packing costs more than it saves.)
using Pixel = std::int32_t __attribute__((vector_size(16)));
using PixelBytes = Byte __attribute__((vector_size(4)));

template <int kBytes>
Pixel load(const Byte* p) {
  std::uint32_t word = 0;
  if constexpr (kBytes == 3) {  // memcpy of three bytes would go through the stack
    word = p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16;
  } else {
    std::memcpy(&word, p, kBytes);
  }
  PixelBytes bytes;
  std::memcpy(&bytes, &word, sizeof(word));
  return __builtin_convertvector(bytes, Pixel);
}

template <int kBytes>
void store(Byte* p, Pixel pixel) {
  const PixelBytes bytes = __builtin_convertvector(pixel, PixelBytes);
  std::memcpy(p, &bytes, kBytes);
}

Pixel absolute(Pixel v) { return v < 0 ? -v : v; }

/// The one of left, above and above left that is nearest to left + above - above left, in this
/// order where two are as near.
Pixel paeth(Pixel left, Pixel above, Pixel above_left) {
  const Pixel rise = above - above_left, step = left - above_left;
  const Pixel to_left = absolute(rise), to_above = absolute(step);
  const Pixel to_above_left = absolute(rise + step);
  const Pixel nearer = to_above <= to_above_left ? above : above_left;
  return ((to_left <= to_above) & (to_left <= to_above_left)) ? left : nearer;
}

template <int kBytes>
void undo_paeth(Byte* __restrict row, std::size_t bytes, const Byte* __restrict above) {
  Pixel left{}, above_left{};
  for (std::size_t i = 0; i < bytes; i += kBytes) {
    const Pixel up = load<kBytes>(above + i);
    left = (load<kBytes>(row + i) + paeth(left, up, above_left)) & 255;
    above_left = up;
    store<kBytes>(row + i, left);
  }
}

template <int kBytes>
bool unfilter(Byte filter, Byte* __restrict row, std::size_t bytes, const Byte* __restrict above) {
  switch (filter) {
    case 0:
      return true;
    case 1:
      undo<kBytes>(row, bytes, above, [](int left, int) { return left; });
      return true;
    case 2:
      for (std::size_t i = 0; i < bytes; ++i) row[i] = static_cast<Byte>(row[i] + above[i]);
      return true;
    case 3:
      undo<kBytes>(row, bytes, above, [](int left, int up) { return (left + up) >> 1; });
      return true;
    case 4:
      undo_paeth<kBytes>(row, bytes, above);
      return true;
    default:
      return false;
  }
}

}  // namespace

bool unfilter_row(Byte filter, int bytes_per_pixel, Byte* row, std::size_t bytes,
                  const Byte* above) {
  switch (bytes_per_pixel) {
    case 1:
      return unfilter<1>(filter, row, bytes, above);
    case 2:
      return unfilter<2>(filter, row, bytes, above);
    case 3:
      return unfilter<3>(filter, row, bytes, above);
    default:
      return unfilter<4>(filter, row, bytes, above);
  }
}

}  // namespace fovea
