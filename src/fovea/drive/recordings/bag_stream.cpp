#include "fovea/drive/recordings/bag_stream.h"

#include <fmt/format.h>

#include "fovea/drive/recordings/decompress.h"
#include "fovea/errors.h"

namespace fovea {

BagStream::BagStream(const std::filesystem::path& file, const std::filesystem::path& shown)
    : name_(shown.string()),
      input_(file, kStreamedFile),
      stream_(input_.stream()),
      size_(input_.size()) {}

std::string BagStream::here() const { return fmt::format("{}, byte {}", name_, place_); }

std::string BagStream::cut_short_at(std::uint64_t place) const {
  return fmt::format("{}: the recording is cut short; it was read up to byte {}", name_, place);
}

std::string_view BagStream::take(std::uint64_t size) {
  if (size > kMaxBagBlock) {
    throw InputError(fmt::format("a record has {} bytes", size), here(),
                     "restore the recording from a copy, or write it with smaller chunks");
  }
  buffer_.resize(size);
  stream_.read(buffer_.data(), std::streamsize(size));
  if (std::uint64_t(stream_.gcount()) != size) {
    throw InputError("the file cannot be read", here(), "restore the recording from a copy");
  }
  place_ += size;
  return buffer_;
}

void BagStream::skip(std::uint64_t size) {
  place_ += size;
  stream_.seekg(std::streamoff(place_));
}

}  // namespace fovea
