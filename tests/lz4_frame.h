// Compresses as recordings do.
#pragma once

#include <lz4frame.h>

#include <string>

namespace fovea {

inline std::string lz4(const std::string& bytes) {
  std::string packed(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
  return packed;
}

}  // namespace fovea
