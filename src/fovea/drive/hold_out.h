// Which frames are held out of a map: they add no point and no colour (docs/method.md 7).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fovea {

class HoldOut {
 public:
  HoldOut() = default;
  /// "N:R" (frames with index % N == R), blocks "A-B,C-D" (both ends held out), or "" (none).
  /// ConfigError otherwise.
  static HoldOut parse(std::string_view spec);

  bool contains(int frame) const;
  bool none() const { return modulus_ == 0 && blocks_.empty(); }
  const std::string& spec() const { return spec_; }

 private:
  struct Block {
    int first, last;
  };
  std::string spec_;
  int modulus_ = 0, remainder_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace fovea
