// The header of a PCD file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fovea/core/point_formats/cloud_rows.h"
#include "fovea/core/read_file.h"

namespace fovea {

struct PcdField {
  std::string name;
  Scalar type = Scalar::kFloat;
  std::size_t count = 1;   ///< numbers
  std::size_t offset = 0;  ///< in a point, bytes
  std::size_t first = 0;   ///< in a point, numbers
};

struct PcdHeader {
  enum class Encoding { kAscii, kBinary, kCompressed };

  Encoding encoding = Encoding::kAscii;
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t point_bytes = 0;  ///< of a point
  std::size_t numbers = 0;      ///< of a point
  bool organized = false;       ///< the points are an image of several rows
};

/// Reads the header; `lines` then is at the first byte of the data.
/// @param name         of the file, for errors
/// @param description  of the columns that the reader needs, for errors
/// @throws InputError  that names the line
PcdHeader read_pcd_header(LineReader& lines, const std::string& name,
                          const std::string& description);

}  // namespace fovea
