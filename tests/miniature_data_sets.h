// Made-up miniatures of data sets, in the layout of their documentation.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fovea/drive/writers/png_encode.h"
#include "fovea/image.h"

namespace fovea {

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// Points at (first, 1, -1), (first + 1, 1, -1), ... of `columns` numbers.
inline void write_points(const std::filesystem::path& file, float first, std::size_t columns) {
  std::string bytes;
  for (int i = 0; i < 200; ++i) {
    std::vector<float> row = {first + 0.05f * float(i), 1, -1, 0.5f, float(i % 32)};
    row.resize(columns);
    bytes.append(reinterpret_cast<const char*>(row.data()), columns * sizeof(float));
  }
  write_text(file, bytes);
}

inline void write_png(const std::filesystem::path& file, int width, int height, std::uint8_t gray) {
  Image image(width, height, 3);
  std::fill(image.data.begin(), image.data.end(), gray);
  const std::vector<std::uint8_t> png = encode_png(image);
  write_text(file, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace fovea
