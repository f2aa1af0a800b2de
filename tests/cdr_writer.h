// Writes CDR messages.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "fovea/geometry/quaternion_motion.h"

namespace fovea {

class CdrWriter {
 public:
  explicit CdrWriter(bool big_endian = false) : big_endian_(big_endian) {}

  template <class T>
  CdrWriter& number(T value) {
    body_.resize((body_.size() + sizeof(T) - 1) / sizeof(T) * sizeof(T), '\xaa');
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big_endian_) std::reverse(bytes.begin(), bytes.end());
    body_.append(bytes.data(), bytes.size());
    return *this;
  }
  CdrWriter& text(std::string_view text) {
    number(std::uint32_t(text.size() + 1));
    body_ += text;
    body_ += '\0';
    return *this;
  }
  CdrWriter& bytes(std::string_view bytes) {
    number(std::uint32_t(bytes.size()));
    body_ += bytes;
    return *this;
  }
  CdrWriter& header(std::int32_t sec, std::uint32_t nanosec, std::string_view frame) {
    return number(sec).number(nanosec).text(frame);
  }
  CdrWriter& motion(const QuaternionMotion& T) {
    for (const double x : T.translation) number(x);
    for (const double x : T.rotation.coeffs()) number(x);
    return *this;
  }
  CdrWriter& doubles(std::size_t count, double value = 0) {
    while (count-- > 0) number(value);
    return *this;
  }

  std::string message() const {
    return std::string(big_endian_ ? "\0\0\0\0" : "\0\1\0\0", 4) + body_;
  }

 private:
  bool big_endian_;
  std::string body_;
};

}  // namespace fovea
