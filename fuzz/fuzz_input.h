// What the fuzzers share: an input as a file, and what a reader may do with it.
#pragma once

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "fovea/errors.h"

namespace fovea {

/// Stops the fuzzer, which then keeps the input, unless what a reader promises is true.
inline void require(bool promise, std::string_view what) {
  if (promise) return;
  fmt::print(stderr, "broken promise: {}\n", what);
  std::abort();
}

/// Runs a reader, which may refuse its input in the way that its header says and in no other.
/// @return whether it did not
template <class Refusal = InputError, class Read>
bool read_or_refuse(Read&& read) {
  try {
    read();
    return true;
  } catch (const Refusal&) {
    return false;
  }
}

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A file in memory under a name that readers can open; one serves a whole run of a fuzzer.
class FileInMemory {
 public:
  FileInMemory() : file_(memfd_create("fovea_fuzz", 0)) {
    require(file_ >= 0, "the system has files in memory");
  }
  ~FileInMemory() { close(file_); }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  /// Replaces the content.
  const std::filesystem::path& hold(std::string_view bytes) {
    require(ftruncate(file_, 0) == 0 &&
                pwrite(file_, bytes.data(), bytes.size(), 0) == std::ssize(bytes),
            "a file in memory can be written");
    return path_;
  }

 private:
  int file_;
  std::filesystem::path path_ = fmt::format("/proc/self/fd/{}", file_);
};

}  // namespace fovea
