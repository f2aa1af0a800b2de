#include "fovea/mapping/hilbert_order.h"

#include <algorithm>
#include <array>
#include <bit>

namespace fovea {
namespace {

constexpr int kLevels = 16;  // bits of a cell coordinate; a key has twice as many

// One level of the curve as a state machine. A state is the curve's orientation inside a square:
// bit 0 swaps x and y, bit 1 turns both around.
struct Step {
  std::uint8_t digit;  // which quarter of the curve the quadrant is
  std::uint8_t next;   // state inside that quadrant
};
constexpr std::array<Step, 16> make_steps() {
  std::array<Step, 16> steps{};
  for (unsigned state = 0; state < 4; ++state) {
    for (unsigned quadrant = 0; quadrant < 4; ++quadrant) {
      unsigned x = quadrant >> 1, y = quadrant & 1;
      if (state & 2) x ^= 1, y ^= 1;
      if (state & 1) std::swap(x, y);
      // The unturned curve visits (0,0), (0,1), (1,1), (1,0); its first quarter is transposed, its
      // last one transposed and turned around.
      const unsigned digit = (3 * x) ^ y;
      const unsigned turn = digit == 0 ? 1 : digit == 3 ? 3 : 0;
      steps[4 * state + quadrant] = {static_cast<std::uint8_t>(digit),
                                     static_cast<std::uint8_t>(state ^ turn)};
    }
  }
  return steps;
}
constexpr std::array<Step, 16> kSteps = make_steps();

std::uint32_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint32_t key = 0, state = 0;
  for (int level = kLevels - 1; level >= 0; --level) {
    const Step step = kSteps[4 * state + 2 * ((x >> level) & 1) + ((y >> level) & 1)];
    key = key << 2 | step.digit;
    state = step.next;
  }
  return key;
}

struct Keyed {
  std::uint32_t key, index;
};

// Stable least-significant-digit radix sort: three passes for 32-bit keys.
void radix_sort(std::vector<Keyed>& items) {
  constexpr int kDigitBits = 11;
  std::vector<Keyed> sorted(items.size());
  for (int shift = 0; shift < 2 * kLevels; shift += kDigitBits) {
    std::array<std::uint32_t, (1 << kDigitBits) + 1> start{};
    const auto digit = [&](const Keyed& item) {
      return (item.key >> shift) & ((1u << kDigitBits) - 1);
    };
    for (const Keyed& item : items) ++start[digit(item) + 1];
    for (std::size_t d = 1; d < start.size(); ++d) start[d] += start[d - 1];
    for (const Keyed& item : items) sorted[start[digit(item)]++] = item;
    items.swap(sorted);
  }
}

}  // namespace

std::vector<std::uint32_t> hilbert_order(std::span<const GridPoint> points) {
  if (points.empty()) return {};
  GridPoint low = points[0], high = points[0];
  for (const GridPoint p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto span = std::max(std::int64_t{high.x} - low.x, std::int64_t{high.y} - low.y);
  const int shift =
      std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(span))) - kLevels);

  std::vector<Keyed> items(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto x = static_cast<std::uint32_t>((std::int64_t{points[i].x} - low.x) >> shift);
    const auto y = static_cast<std::uint32_t>((std::int64_t{points[i].y} - low.y) >> shift);
    items[i] = {hilbert_key(x, y), i};
  }
  radix_sort(items);
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = items[i].index;
  return order;
}

}  // namespace fovea
