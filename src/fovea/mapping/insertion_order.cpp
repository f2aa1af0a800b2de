#include "fovea/mapping/insertion_order.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "fovea/core/radix_sort.h"
#include "fovea/core/random.h"

namespace fovea {
namespace {

constexpr int kLevels = 15;  // bits of a cell's coordinate
constexpr int kRounds = 3;
static_assert(2 * kLevels + 2 == 32);

/// Position of a cell on the Hilbert curve.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  std::uint32_t index = 0;
  // Orientation of the curve in a square: bit 0 exchanges x and y, bit 1 rotates by 180 degrees.
  std::uint32_t state = 0;
  for (int level = kLevels - 1; level >= 0; --level) {
    std::uint32_t right = (x >> level & 1) ^ (state >> 1), up = (y >> level & 1) ^ (state >> 1);
    if (state & 1) std::swap(right, up);
    // In state 0 the curve visits (0,0), (0,1), (1,1), (1,0). It is transposed in the first
    // quadrant, and transposed and rotated in the last one.
    const std::uint32_t quadrant = (3 * right) ^ up;
    index = index << 2 | quadrant;
    state ^= quadrant == 0 ? 1 : quadrant == 3 ? 3 : 0;
  }
  return index;
}

std::uint32_t round_of(std::uint32_t index) {
  const int zeros = std::countr_zero(Random(index).next());
  return static_cast<std::uint32_t>(kRounds - 1 - std::min(zeros / 2, kRounds - 1));
}

struct Keyed {
  std::uint32_t key, index;
};

}  // namespace

std::vector<std::uint32_t> insertion_order(std::span<const GridPoint> points) {
  if (points.empty()) return {};
  GridPoint low = points[0], high = points[0];
  for (const GridPoint p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto extent = static_cast<std::uint32_t>(
      std::max(std::int64_t{high.x} - low.x, std::int64_t{high.y} - low.y));
  const int shift = std::max(0, static_cast<int>(std::bit_width(extent)) - kLevels);

  std::vector<Keyed> items(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto x = static_cast<std::uint32_t>((std::int64_t{points[i].x} - low.x) >> shift);
    const auto y = static_cast<std::uint32_t>((std::int64_t{points[i].y} - low.y) >> shift);
    items[i] = {round_of(i) << (2 * kLevels) | hilbert_index(x, y), i};
  }
  radix_sort(items, 2 * kLevels + 2);
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = items[i].index;
  return order;
}

}  // namespace fovea
