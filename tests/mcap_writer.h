// Writes MCAP files record by record, right ones and wrong ones.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>

namespace fovea::mcap {

template <class T>
std::string number(T value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  return {bytes.data(), bytes.size()};
}
inline std::string text(const std::string& letters) {
  return number(std::uint32_t(letters.size())) + letters;
}
inline std::string record(int opcode, const std::string& content) {
  return number(std::uint8_t(opcode)) + number(std::uint64_t(content.size())) + content;
}
/// A channel and its schema, of the same number.
inline std::string channel(int id, const std::string& topic, const std::string& encoding = "cdr",
                           const std::string& type = "pkg/msg/Type") {
  return record(3, number(std::uint16_t(id)) + text(type) + text("ros2msg") + text("")) +
         record(4, number(std::uint16_t(id)) + number(std::uint16_t(id)) + text(topic) +
                       text(encoding) + text(""));
}
inline std::string message(int channel_id, const std::string& bytes) {
  return record(5, number(std::uint16_t(channel_id)) + std::string(20, '\0') + bytes);
}
inline std::string chunk(const std::string& records, const std::string& compression,
                         const std::string& stored, std::uint32_t crc = 0) {
  return record(6, std::string(16, '\0') + number(std::uint64_t(records.size())) + number(crc) +
                       text(compression) + number(std::uint64_t(stored.size())) + stored);
}
inline std::string file_of(const std::string& records) {
  const std::string magic("\x89MCAP0\r\n", 8);
  return magic + record(1, text("ros2") + text("test")) + records + record(15, std::string(4, 0)) +
         record(2, std::string(20, '\0')) + magic;
}

}  // namespace fovea::mcap
