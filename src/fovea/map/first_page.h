// The first page of a map file: header and list of tables. It can be replaced, because it is the
// same in all maps. Private to map/.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace fovea {

/// "300,000 of 400,000 bytes are there" if a file is shorter than its header states; nothing
/// otherwise, or if the header is not that of an SQLite file.
std::optional<std::string> missing_bytes(const std::filesystem::path& map);

/// Whether the constant parts of a header of SQLite are not those of a map, but the pages are.
bool has_damaged_header(const std::filesystem::path& file);

/// Whether the pages behind the first one begin as those of a map.
bool has_pages_of_map(const std::filesystem::path& file);

/// A copy of a map with the first page of a new map, in the folder for temporary files.
class CopyWithNewFirstPage {
 public:
  /// OutputError if the copy cannot be written.
  explicit CopyWithNewFirstPage(const std::filesystem::path& map);
  ~CopyWithNewFirstPage();
  CopyWithNewFirstPage(const CopyWithNewFirstPage&) = delete;
  CopyWithNewFirstPage& operator=(const CopyWithNewFirstPage&) = delete;

  std::filesystem::path path() const { return folder_ / "copy.fovea"; }

 private:
  std::filesystem::path folder_;
};

}  // namespace fovea
