// Recognition of file formats by content. Names of files decide nothing.
#pragma once

#include <cstddef>
#include <string_view>

namespace fovea {

enum class FileFormat {
  kUnknown,
  kText,
  kPcd,
  kPly,
  kLas,
  kLaz,
  kE57,
  kPng,
  kJpeg,
  kSqlite,
  kMcap,
  kRosBag1,
  kZstd,
  kOther  ///< known by name alone, see format_name()
};

/// Bytes from the start of a file that sniff_format() uses at most.
inline constexpr std::size_t kSniffedBytes = 512;

struct SniffedFormat {
  FileFormat format = FileFormat::kUnknown;
  std::string_view name = "data of an unknown format";  ///< with its article where it has one
};

/// Recognizes a format by the first bytes of a file. Needs the first kSniffedBytes, or all bytes of
/// a shorter file.
SniffedFormat sniff_format(std::string_view beginning);

}  // namespace fovea
