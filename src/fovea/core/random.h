// Random numbers whose seed belongs to an item, not to a thread.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace fovea {

/// SplitMix64 (Steele, Lea, Flood 2014): 64-bit state, passes BigCrush, trivially seedable per
/// item.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// Numbers of one item (a frame, a point) of one kind (any constant): those of other items, kinds
  /// and seeds have nothing to do with them.
  static Random of_item(std::uint64_t seed, std::uint64_t kind, std::uint64_t item) {
    return Items(seed, kind).of(item);
  }
  /// of_item() for many items of one seed and kind, which are mixed once.
  class Items {
   public:
    Items(std::uint64_t seed, std::uint64_t kind)
        : mixed_(Random(Random(seed).next() ^ kind).next()) {}
    Random of(std::uint64_t item) const { return Random(Random(mixed_ ^ item).next()); }

   private:
    std::uint64_t mixed_;
  };

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [0, bound); the bias is below bound / 2^64.
  std::uint64_t below(std::uint64_t bound) {
    __extension__ using Uint128 = unsigned __int128;
    return static_cast<std::uint64_t>((static_cast<Uint128>(next()) * bound) >> 64);
  }
  /// Standard normal (Box and Muller 1958; the second number of a pair is not kept, so that every
  /// draw takes the same two from the sequence).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

/// 32 bits that look like chance, of an item's number (Wellons 2018, "lowbias32", the least biased
/// mixer of its form). For loops over many items: the compiler works them eight wide, which it
/// cannot do with 64 bits.
/// @param kind  any constant
inline std::uint32_t quick_bits(std::uint32_t item, std::uint32_t kind) {
  std::uint32_t x = item ^ kind;
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

}  // namespace fovea
