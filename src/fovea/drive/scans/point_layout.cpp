#include "fovea/drive/scans/point_layout.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace fovea {
namespace {

constexpr std::uint32_t kFewest = 3, kMost = 8;  // numbers per point
/// With fewer values the shares are chance.
constexpr std::size_t kLeastValues = 128;
/// Blocks of values at even steps through the file.
constexpr std::size_t kBlock = 64, kBlocks = 32;
/// The smallest number of columns counts whose share is nearly the best one.
constexpr double kNearlyBest = 0.85;
/// A share that chance does not reach with kLeastValues.
constexpr double kLeastShare = 0.1;

/// Sign and exponent of a value, and its place in the file.
struct Value {
  std::uint32_t index;
  std::array<double, 2> features;
};

Value value_at(std::span<const std::uint8_t> bytes, std::size_t index) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes.data() + index * sizeof bits, sizeof bits);
  // Magnitudes from 2^-20 to 2^20: zero must not outweigh all others.
  const std::uint32_t exponent = std::clamp(bits >> 23 & 0xffu, 107u, 147u);
  return {static_cast<std::uint32_t>(index),
          {static_cast<double>(bits >> 31), static_cast<double>(exponent)}};
}

std::vector<Value> sample(std::span<const std::uint8_t> bytes) {
  const std::size_t count = bytes.size() / sizeof(float);
  std::vector<Value> values;
  if (count <= kBlock * kBlocks) {
    for (std::size_t i = 0; i < count; ++i) values.push_back(value_at(bytes, i));
    return values;
  }
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::size_t begin = block * (count - kBlock) / (kBlocks - 1);
    for (std::size_t i = 0; i < kBlock; ++i) values.push_back(value_at(bytes, begin + i));
  }
  return values;
}

/// Share of a feature's variance that lies between the columns.
double share_between_columns(const std::vector<Value>& values, std::uint32_t columns,
                             std::size_t feature) {
  std::array<double, kMost> sum{}, count{};
  double total = 0, squares = 0;
  for (const Value& value : values) {
    const double x = value.features[feature];
    sum[value.index % columns] += x;
    ++count[value.index % columns];
    total += x;
    squares += x * x;
  }
  const double n = static_cast<double>(values.size()), mean = total / n;
  const double variance = squares / n - mean * mean;
  if (variance <= 1e-9) return 0;
  double between = 0;
  for (std::size_t column = 0; column < columns; ++column) {
    const double deviation = sum[column] / count[column] - mean;
    between += count[column] / n * deviation * deviation;
  }
  return between / variance;
}

}  // namespace

std::optional<std::size_t> numbers_per_point(std::span<const std::uint8_t> bytes) {
  const std::vector<Value> values = sample(bytes);
  if (values.size() < kLeastValues) return std::nullopt;
  std::array<double, kMost + 1> share{};
  for (std::uint32_t columns = kFewest; columns <= kMost; ++columns) {
    share[columns] = std::max(share_between_columns(values, columns, 0),
                              share_between_columns(values, columns, 1));
  }
  const double best = *std::max_element(share.begin(), share.end());
  if (best < kLeastShare) return std::nullopt;
  std::size_t columns = kFewest;
  while (share[columns] < kNearlyBest * best) ++columns;
  return columns;
}

}  // namespace fovea
