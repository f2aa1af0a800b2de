// Numbers, texts and sequences of a message: of ROS 2 (CDR, OMG Common Data Representation, XCDR
// version 1), and of ROS 1 (wiki.ros.org/roscpp/Overview/MessagesSerializationAndAdaptingTypes).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace fovea {

/// Reads one after the other. CDR aligns numbers to their size; ROS 1 has no gaps. InputError that
/// names `where` if the message ends early or has another representation.
class MessageReader {
 public:
  /// @param message   of CDR: with its four bytes of encapsulation
  /// @param encoding  kCdrEncoding or kRos1Encoding
  MessageReader(std::string_view message, std::string_view encoding, std::string where);

  bool is_ros1() const { return is_ros1_; }

  template <class T>
  T number() {
    std::array<char, sizeof(T)> bytes;
    aligned(sizeof(T), sizeof(T)).copy(bytes.data(), sizeof(T));
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }
  bool boolean() { return number<std::uint8_t>() != 0; }
  std::string_view text();
  /// A sequence of bytes, or of characters.
  std::string_view bytes();
  /// An array of as many bytes.
  std::string_view block(std::size_t size) { return aligned(1, size); }
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

  bool is_ros1_;
  std::string_view body_;  // alignment counts from its beginning
  std::size_t at_ = 0;
  std::string where_;
  bool swapped_ = false;
};

}  // namespace fovea
