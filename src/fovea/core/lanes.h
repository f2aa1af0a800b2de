// Eight floats computed side by side.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace fovea {

/// GCC's and Clang's vector extension: the operators of floats, lane by lane, on any processor; on
/// one that has AVX, in one instruction each.
using Lanes = float __attribute__((vector_size(32)));
using LaneMask = std::int32_t __attribute__((vector_size(32)));  // -1 where true
inline constexpr int kLanes = 8;

inline Lanes all_lanes(float value) { return value - Lanes{}; }

/// From and to eight floats in a row, anywhere.
inline Lanes lanes_at(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(Lanes));
  return lanes;
}
inline void put_lanes(const Lanes& lanes, float* to) { std::memcpy(to, &lanes, sizeof(Lanes)); }

/// True in the first `count` lanes, in all where there are no more than eight.
inline LaneMask first_lanes(std::size_t count) {
  constexpr LaneMask kNumber{0, 1, 2, 3, 4, 5, 6, 7};
  return kNumber < static_cast<std::int32_t>(count);
}

/// The value where the mask is true, 0 elsewhere.
inline Lanes where(LaneMask mask, Lanes value) {
  return reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(value) & mask);
}

inline Lanes min_of(const Lanes& a, const Lanes& b) { return a < b ? a : b; }

inline Lanes sqrt_of(Lanes v) {
  for (int i = 0; i < kLanes; ++i) v[i] = std::sqrt(v[i]);
  return v;
}

using HalfLanes = float __attribute__((vector_size(16)));

inline HalfLanes low_half(const Lanes& v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
inline HalfLanes high_half(const Lanes& v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }

inline float min_of_lanes(const Lanes& v) {
  const HalfLanes low = low_half(v), high = high_half(v), four = low < high ? low : high;
  const HalfLanes crossed = __builtin_shufflevector(four, four, 2, 3, 0, 1);
  const HalfLanes two = four < crossed ? four : crossed;
  return two[0] < two[1] ? two[0] : two[1];
}

/// Of four at once, as they come. Lanes i and i + 4 are added first, then neighbours: the same on
/// every processor.
inline HalfLanes sums_of_lanes(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d) {
  const auto add_pairs = [](const HalfLanes& x, const HalfLanes& y) {
    return __builtin_shufflevector(x, y, 0, 2, 4, 6) + __builtin_shufflevector(x, y, 1, 3, 5, 7);
  };
  const auto halves = [](const Lanes& v) { return low_half(v) + high_half(v); };
  return add_pairs(add_pairs(halves(a), halves(b)), add_pairs(halves(c), halves(d)));
}
inline float sum_of_lanes(const Lanes& v) { return sums_of_lanes(v, v, v, v)[0]; }

/// A bit for each lane, the first one's lowest.
inline unsigned bits_of(const LaneMask& mask) {
  constexpr LaneMask kBit{1, 2, 4, 8, 16, 32, 64, 128};
  const LaneMask bits = mask & kBit;
  const auto four = __builtin_shufflevector(bits, bits, 0, 1, 2, 3) |
                    __builtin_shufflevector(bits, bits, 4, 5, 6, 7);
  const auto two = four | __builtin_shufflevector(four, four, 2, 3, 0, 1);
  return static_cast<unsigned>(two[0] | two[1]);
}

}  // namespace fovea
