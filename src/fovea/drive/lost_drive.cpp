#include "fovea/drive/lost_drive.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <iterator>
#include <system_error>

namespace fovea {
namespace {

/// Files next to the one in question that must not be readable either.
constexpr std::ptrdiff_t kNeighbors = 2;

/// Why the first byte of a file cannot be read; no error if it can, or if the file is empty.
std::error_code read_error(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return {errno, std::generic_category()};
  char first = 0;
  const ssize_t got = ::read(descriptor, &first, 1);
  const std::error_code error(got < 0 ? errno : 0, std::generic_category());
  ::close(descriptor);
  return error;
}

}  // namespace

void require_drive(const NumberedFiles& files, int index, const std::filesystem::path& drive) {
  const auto file = files.find(index);
  if (file == files.end()) return;
  const std::error_code error = read_error(file->second);
  if (!error) return;
  auto end = std::next(file);
  std::ptrdiff_t checked = 0;
  for (; end != files.end() && checked < kNeighbors; ++end, ++checked) {
    if (!read_error(end->second)) return;
  }
  for (auto before = file; before != files.begin() && checked < kNeighbors; ++checked) {
    --before;
    if (!read_error(before->second)) return;
  }
  if (checked == 0) return;
  throw DriveLostError(
      fmt::format("the drive cannot be read from frame {} on ({})", index, error.message()),
      drive.string(), "make it readable again");
}

}  // namespace fovea
