#include "fovea/core/point_formats/lzf.h"

namespace fovea {

std::optional<std::string> lzf_decompress(std::string_view packed, std::size_t size) {
  std::string out;
  out.reserve(size);
  const auto byte = [&](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(packed[at]));
  };
  std::size_t in = 0;
  while (in < packed.size()) {
    const std::size_t control = byte(in++);
    if (control < 32) {  // control + 1 bytes as they are
      const std::size_t count = control + 1;
      if (count > packed.size() - in || count > size - out.size()) return std::nullopt;
      out.append(packed, in, count);
      in += count;
      continue;
    }
    // A copy of earlier bytes: 3 bits of length (all ones: one more byte of it), 13 of distance.
    std::size_t count = (control >> 5) + 2;
    if (control >> 5 == 7) {
      if (in == packed.size()) return std::nullopt;
      count += byte(in++);
    }
    if (in == packed.size()) return std::nullopt;
    const std::size_t distance = ((control & 31) << 8 | byte(in++)) + 1;
    if (distance > out.size() || count > size - out.size()) return std::nullopt;
    // Byte by byte: a copy may overlap what it writes.
    for (std::size_t i = 0; i < count; ++i) out.push_back(out[out.size() - distance]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace fovea
