#include "fovea/map/value_plane.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fovea {
namespace {

/// Neighbors in a tile are neighbors in space: their differences are small and compress well. An
/// even number is a difference of half of it, an odd one of minus half of the next.
std::uint16_t difference(std::uint16_t from, std::uint16_t to) {
  const auto d = static_cast<std::int16_t>(static_cast<std::uint16_t>(to - from));
  return static_cast<std::uint16_t>((static_cast<unsigned>(d) << 1) ^
                                    static_cast<unsigned>(d >> 15));
}
std::uint16_t following(std::uint16_t from, std::uint16_t difference) {
  const unsigned d = (difference >> 1) ^ (0u - (difference & 1u));
  return static_cast<std::uint16_t>(from + d);
}

}  // namespace

void pack_plane(std::span<const std::uint16_t> values, std::byte* bytes) {
  const std::size_t n = values.size();
  // By blocks of their own memory: the compiler then knows that nothing overlaps, and works on
  // sixteen values at a time.
  constexpr std::size_t kBlock = 256;
  std::array<std::uint16_t, kBlock> differences;
  std::array<std::byte, kBlock> lower, upper;
  std::uint16_t last = 0;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t count = std::min(kBlock, n - begin);
    const std::uint16_t* block = values.data() + begin;
    differences[0] = difference(last, block[0]);
    for (std::size_t i = 1; i < count; ++i) differences[i] = difference(block[i - 1], block[i]);
    for (std::size_t i = 0; i < count; ++i) {
      lower[i] = static_cast<std::byte>(differences[i] & 255);
      upper[i] = static_cast<std::byte>(differences[i] >> 8);
    }
    std::memcpy(bytes + begin, lower.data(), count);
    std::memcpy(bytes + n + begin, upper.data(), count);
    last = block[count - 1];
  }
}
void unpack_plane(std::size_t n, const std::byte* bytes, std::vector<std::uint16_t>& values) {
  values.resize(n);
  std::uint16_t last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    last =
        following(last, static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[i]) |
                                                   std::to_integer<unsigned>(bytes[n + i]) << 8));
    values[i] = last;
  }
}

}  // namespace fovea
