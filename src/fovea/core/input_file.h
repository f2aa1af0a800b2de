// Files that are read. One place opens them: each must be a regular file of a plausible size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace fovea {

/// What a file is read as, and the size that no such file exceeds (docs/limits.md).
struct FileKind {
  const char* noun;         ///< for errors: "the NOUN cannot be read"
  std::uintmax_t max_size;  ///< bytes
};
inline constexpr std::uintmax_t kMebibyte = std::uintmax_t{1} << 20;
inline constexpr std::uintmax_t kNoLimit = std::numeric_limits<std::uintmax_t>::max();
inline constexpr FileKind kScanFile{"scan", 512 * kMebibyte};
inline constexpr FileKind kImageFile{"image", 256 * kMebibyte};
/// Tables, calibration and other texts; the truth of simulated drives.
inline constexpr FileKind kDataFile{"data file", 1024 * kMebibyte};
inline constexpr FileKind kSettingsFile{"configuration", 4 * kMebibyte};
inline constexpr FileKind kCalibrationFile{"calibration file", 4 * kMebibyte};
inline constexpr FileKind kDescriptionFile{"description", 256 * kMebibyte};  ///< JSON, YAML, XML
/// Read piece by piece, so that the size does not matter.
inline constexpr FileKind kStreamedFile{"file", kNoLimit};

/// A file that is open for reading.
class InputFile {
 public:
  /// Opens the file without waiting. InputError if it is missing, is no regular file (a folder,
  /// pipe, device or socket) or is larger than its kind can be.
  InputFile(const std::filesystem::path& path, const FileKind& kind);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uintmax_t size() const { return size_; }  ///< bytes, at the time of opening
  int descriptor() const { return descriptor_; }

  /// The first bytes, at most `count`. Does not move the stream.
  std::string beginning(std::size_t count) const { return range(0, count); }
  /// The bytes from an offset on, at most `count`. Does not move the stream.
  std::string range(std::uintmax_t offset, std::size_t count) const;
  /// All bytes. InputError if the file cannot be read to its end.
  std::vector<std::uint8_t> bytes() const;
  /// A stream of the content, from its begin at the first call.
  std::istream& stream();

 private:
  [[noreturn]] void fail(const std::string& reason) const;
  /// Reads at an offset until `count` bytes are there or the file ends.
  std::size_t read_at(std::uintmax_t offset, char* bytes, std::size_t count) const;

  class Buffer;
  std::filesystem::path path_;
  FileKind kind_;
  int descriptor_ = -1;
  std::uintmax_t size_ = 0;
  std::unique_ptr<Buffer> buffer_;
  std::unique_ptr<std::istream> stream_;
};

/// InputError if there is a file of this name that is no regular file. A missing file is none.
/// For libraries that open files by name.
void require_regular_if_present(const std::filesystem::path& path, const FileKind& kind);

}  // namespace fovea
