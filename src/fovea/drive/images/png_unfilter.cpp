#include "fovea/drive/images/png_unfilter.h"

#include <cstdlib>

namespace fovea {
namespace {

using Byte = std::uint8_t;

/// Adds predict(left, above, above_left) to each byte of a row.
template <class Predict>
void undo(int bytes_per_pixel, Byte* row, std::size_t bytes, const Byte* above, Predict predict) {
  const auto step = static_cast<std::size_t>(bytes_per_pixel);
  for (std::size_t i = 0; i < bytes; ++i) {
    const int left = i < step ? 0 : row[i - step], above_left = i < step ? 0 : above[i - step];
    row[i] = static_cast<Byte>(row[i] + predict(left, int{above[i]}, above_left));
  }
}

/// The one of left, above and above left that is nearest to left + above - above left. The first
/// in this order if two are equally near.
int paeth(int left, int above, int above_left) {
  const int to_left = std::abs(above - above_left), to_above = std::abs(left - above_left);
  const int to_above_left = std::abs(left + above - 2 * above_left);
  if (to_left <= to_above && to_left <= to_above_left) return left;
  return to_above <= to_above_left ? above : above_left;
}

}  // namespace

bool unfilter_row(Byte filter, int bytes_per_pixel, Byte* row, std::size_t bytes,
                  const Byte* above) {
  const auto add = [&](auto predict) { undo(bytes_per_pixel, row, bytes, above, predict); };
  switch (filter) {
    case 0:
      return true;
    case 1:
      add([](int left, int, int) { return left; });
      return true;
    case 2:
      add([](int, int up, int) { return up; });
      return true;
    case 3:
      add([](int left, int up, int) { return (left + up) / 2; });
      return true;
    case 4:
      add(paeth);
      return true;
    default:
      return false;
  }
}

}  // namespace fovea
