// Memory on the disk, for what is looked at once in a while.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace fovea {

/// A file without a name; it is gone when the program ends, however that happens. Errors are
/// OutputError.
class ScratchFile {
 public:
  /// Where values lie.
  struct Place {
    std::size_t offset = 0, bytes = 0;
  };

  /// In the system's folder for temporary files, or in another one.
  ScratchFile();
  explicit ScratchFile(std::filesystem::path folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Writes trivially copyable values behind those that are there.
  template <class T>
  Place append(const std::vector<T>& values) {
    return append_bytes(std::as_bytes(std::span(values)));
  }
  /// Reads what append() has written as the same type.
  template <class T>
  std::vector<T> read(const Place& place) const {
    std::vector<T> values(place.bytes / sizeof(T));
    read(place.offset, std::span(values));
    return values;
  }
  /// Fills values with what lies from an offset on.
  template <class T>
  void read(std::size_t offset, std::span<T> values) const {
    read_bytes(offset, std::as_writable_bytes(values));
  }

 private:
  Place append_bytes(std::span<const std::byte> bytes);
  void read_bytes(std::size_t offset, std::span<std::byte> bytes) const;
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path folder_;
  int fd_ = -1;
  std::size_t size_ = 0;
};

}  // namespace fovea
