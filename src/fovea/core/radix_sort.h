// Sorting by unsigned keys.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fovea {

/// Stable sort by the member `key`, an unsigned number: least significant digit first (Knuth, The
/// Art of Computer Programming 3, 5.2.5).
/// @param bits  largest number of bits of a key
template <class Keyed>
void radix_sort(std::vector<Keyed>& items, int bits) {
  constexpr int kDigitBits = 11;
  std::vector<Keyed> sorted(items.size());
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    std::array<std::uint32_t, (1 << kDigitBits) + 1> start{};
    const auto digit = [&](const Keyed& item) {
      return static_cast<std::size_t>((item.key >> shift) & ((1u << kDigitBits) - 1));
    };
    for (const Keyed& item : items) ++start[digit(item) + 1];
    for (std::size_t d = 1; d < start.size(); ++d) start[d] += start[d - 1];
    for (const Keyed& item : items) sorted[start[digit(item)]++] = item;
    items.swap(sorted);
  }
}

}  // namespace fovea
