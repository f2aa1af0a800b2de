// Numbers and texts of a ROS message: the counterpart of recordings/message_reader.h.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "fovea/drive/recordings/bag_sink.h"

namespace fovea::bridge {

static_assert(std::endian::native == std::endian::little, "messages have little-endian numbers");

/// Appends one after the other. CDR aligns numbers to their size; ROS 1 has no gaps.
class MessageWriter {
 public:
  /// @param encoding  kCdrEncoding or kRos1Encoding
  explicit MessageWriter(std::string_view encoding) : is_ros1_(encoding == kRos1Encoding) {
    if (!is_ros1_) bytes_.assign(kLittleEndianCdr, kEncapsulation);
  }

  bool is_ros1() const { return is_ros1_; }

  template <class T>
  void number(T value) {
    if (!is_ros1_) {
      while ((bytes_.size() - kEncapsulation) % sizeof(T) != 0) bytes_.push_back('\0');
    }
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    bytes_.append(raw.data(), raw.size());
  }

  void text(std::string_view value) {
    const std::size_t end = is_ros1_ ? 0 : 1;  // CDR ends a text by a zero
    number(static_cast<std::uint32_t>(value.size() + end));
    bytes_ += value;
    bytes_.append(end, '\0');
  }

  void doubles(std::span<const double> values) {
    for (const double value : values) number(value);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kEncapsulation = 4;
  static constexpr char kLittleEndianCdr[kEncapsulation] = {0, 1, 0, 0};

  bool is_ros1_;
  std::string bytes_;
};

}  // namespace fovea::bridge
