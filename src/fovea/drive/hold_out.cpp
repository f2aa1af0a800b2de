#include "fovea/drive/hold_out.h"

#include <charconv>
#include <tuple>
#include <utility>

#include "fovea/errors.h"

namespace fovea {
namespace {

[[noreturn]] void reject(std::string_view why, std::string_view spec) {
  throw ConfigError(why, "hold-out \"" + std::string(spec) + "\"",
                    "write N:R (frames with index % N == R) or blocks A-B,C-D");
}

/// Two non-negative integers with `separator` between them and nothing else.
std::pair<int, int> parse_pair(std::string_view text, char separator, std::string_view spec) {
  const auto number = [&](std::string_view digits) {
    int value = -1;
    const char* end = digits.data() + digits.size();
    const auto [rest, error] = std::from_chars(digits.data(), end, value);
    if (error != std::errc() || rest != end || value < 0) {
      reject("\"" + std::string(digits) + "\" is no frame number", spec);
    }
    return value;
  };
  const std::size_t middle = text.find(separator);
  if (middle == std::string_view::npos) {
    reject("\"" + std::string(text) + "\" is no pair of numbers", spec);
  }
  return {number(text.substr(0, middle)), number(text.substr(middle + 1))};
}

}  // namespace

HoldOut HoldOut::parse(std::string_view spec) {
  HoldOut held;
  held.spec_ = spec;
  if (spec.empty()) return held;
  if (spec.find(':') != std::string_view::npos) {
    std::tie(held.modulus_, held.remainder_) = parse_pair(spec, ':', spec);
    if (held.modulus_ < 2) reject("N must be 2 or more, or no frame is left", spec);
    if (held.remainder_ >= held.modulus_) reject("R must be less than N", spec);
    return held;
  }
  for (std::size_t begin = 0; begin <= spec.size();) {
    const std::size_t end = std::min(spec.find(',', begin), spec.size());
    const auto [first, last] = parse_pair(spec.substr(begin, end - begin), '-', spec);
    if (first > last) reject("a block ends before it begins", spec);
    held.blocks_.push_back({first, last});
    begin = end + 1;
  }
  return held;
}

bool HoldOut::contains(int frame) const {
  if (modulus_ > 0 && frame % modulus_ == remainder_) return true;
  for (const Block& block : blocks_) {
    if (frame >= block.first && frame <= block.last) return true;
  }
  return false;
}

}  // namespace fovea
