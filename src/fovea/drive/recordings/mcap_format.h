// Constants of MCAP files (mcap.dev/spec).
#pragma once

#include <cstdint>
#include <string_view>

namespace fovea::mcap {

inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kDataEnd = 0x0f,
};

}  // namespace fovea::mcap
