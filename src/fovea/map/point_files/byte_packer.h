// Values one behind the other, as binary formats want them.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace fovea {

// Values are written as they lie in memory; all formats here are little endian.
static_assert(std::endian::native == std::endian::little);

/// Appends to a string that outlives it.
class BytePacker {
 public:
  explicit BytePacker(std::string& bytes) : bytes_(bytes) {}

  template <class T>
  void put(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
  }

  /// Text cut or filled up with zeros to `width` bytes.
  void put_text(std::string_view text, std::size_t width) {
    text = text.substr(0, width);
    bytes_.append(text);
    put_zeros(width - text.size());
  }

  void put_zeros(std::size_t count) { bytes_.append(count, '\0'); }

 private:
  std::string& bytes_;
};

}  // namespace fovea
