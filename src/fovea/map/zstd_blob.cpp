#include "fovea/map/zstd_blob.h"

#include <zstd.h>

#include <new>

namespace fovea {
namespace {

constexpr int kBlobLevel = 1;
/// Bytes of the smallest block of a zstd frame, and of the largest content of a block.
constexpr std::size_t kLeastBlock = 4, kLargestBlockContent = 1 << 17;

}  // namespace

bool can_hold(std::size_t frame_size, std::size_t content_size) {
  return content_size / kLargestBlockContent <= frame_size / kLeastBlock;
}

std::vector<std::byte> compress_blob(std::span<const std::byte> content) {
  std::vector<std::byte> blob(ZSTD_compressBound(content.size()));
  const std::size_t size =
      ZSTD_compress(blob.data(), blob.size(), content.data(), content.size(), kBlobLevel);
  // The destination is large enough, so that only memory can run out.
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();
  blob.resize(size);
  return blob;
}

std::optional<std::vector<std::byte>> decompress_blob(std::span<const std::byte> blob,
                                                      std::size_t largest) {
  const auto size = ZSTD_getFrameContentSize(blob.data(), blob.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR || size > largest ||
      !can_hold(blob.size(), size)) {
    return std::nullopt;
  }
  std::vector<std::byte> content(size);
  if (ZSTD_decompress(content.data(), content.size(), blob.data(), blob.size()) != size) {
    return std::nullopt;
  }
  return content;
}

}  // namespace fovea
