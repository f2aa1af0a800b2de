// Numbers, texts and sequences of a CDR message (OMG Common Data Representation, XCDR version 1),
// as ROS 2 writes them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace fovea {

/// Reads one after the other, aligned as CDR says. InputError that names `where` where the message
/// ends early or is of another representation.
class CdrReader {
 public:
  /// @param message  with its four bytes of encapsulation
  CdrReader(std::string_view message, std::string where);

  template <class T>
  T number() {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), aligned(sizeof(T), sizeof(T)).data(), sizeof(T));
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }
  bool boolean() { return number<std::uint8_t>() != 0; }
  std::string_view text();
  /// A sequence of bytes, or of characters.
  std::string_view bytes();
  /// How many elements follow, of at least `min_bytes` each.
  std::size_t count(std::size_t min_bytes);
  template <std::size_t N>
  std::array<double, N> doubles() {
    std::array<double, N> values;
    for (double& value : values) value = number<double>();
    return values;
  }

  const std::string& where() const { return where_; }

 private:
  std::string_view aligned(std::size_t alignment, std::size_t size);
  [[noreturn]] void throw_too_short() const;

  std::string_view body_;  // alignment counts from its beginning
  std::size_t at_ = 0;
  std::string where_;
  bool swapped_ = false;
};

}  // namespace fovea
