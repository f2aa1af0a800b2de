#include "fovea/mapping/insertion_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "fovea/base/radix_sort.h"
#include "fovea/base/random.h"

namespace fovea {
namespace {

constexpr int kLevels =
    15;  // bits of a cell's coordinate; its position on the curve has twice as many
constexpr int kStepLevels = 3;  // levels taken at once
constexpr int kRounds = 3;
static_assert(kLevels % kStepLevels == 0 && 2 * kLevels + 2 == 32);

// The curve as a state machine. The state is the orientation of the curve in a square: bit 0
// exchanges x and y, bit 1 rotates by 180 degrees.
struct Step {
  unsigned place, state;
};

constexpr Step descend(unsigned state, unsigned x, unsigned y) {
  if (state & 2) x ^= 1, y ^= 1;
  if (state & 1) std::swap(x, y);
  // In state 0 the curve visits (0,0), (0,1), (1,1), (1,0). It is transposed in the first quadrant,
  // and transposed and rotated in the last one.
  const unsigned place = (3 * x) ^ y;
  return {place, state ^ (place == 0 ? 1u : place == 3 ? 3u : 0u)};
}

// For each state and three bits of x and of y: the position along the curve (6 bits) and the next
// state.
constexpr std::array<std::uint8_t, 256> make_steps() {
  std::array<std::uint8_t, 256> steps{};
  for (unsigned i = 0; i < 256; ++i) {
    Step step{0, i >> 6};
    for (int level = kStepLevels - 1; level >= 0; --level) {
      const Step below = descend(step.state, (i >> (3 + level)) & 1, (i >> level) & 1);
      step = {step.place << 2 | below.place, below.state};
    }
    steps[i] = static_cast<std::uint8_t>(step.state << 6 | step.place);
  }
  return steps;
}
constexpr std::array<std::uint8_t, 256> kSteps = make_steps();

std::uint32_t place_on_hilbert_curve(std::uint32_t x, std::uint32_t y) {
  std::uint32_t place = 0, state = 0;  // the state in bits 6 and 7
  for (int level = kLevels - kStepLevels; level >= 0; level -= kStepLevels) {
    const std::uint32_t step = kSteps[state | ((x >> level) & 7) << 3 | ((y >> level) & 7)];
    place = place << 6 | (step & 63);
    state = step & 192;
  }
  return place;
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
    items[i] = {round_of(i) << (2 * kLevels) | place_on_hilbert_curve(x, y), i};
  }
  radix_sort(items, 2 * kLevels + 2);
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = items[i].index;
  return order;
}

}  // namespace fovea
