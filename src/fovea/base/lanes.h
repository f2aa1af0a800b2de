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

inline float min_of_lanes(const Lanes& v) {
  float least = v[0];
  for (int i = 1; i < kLanes; ++i) least = v[i] < least ? v[i] : least;
  return least;
}

/// Pairs first: the same on every processor.
inline float sum_of_lanes(const Lanes& v) {
  return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

}  // namespace fovea
