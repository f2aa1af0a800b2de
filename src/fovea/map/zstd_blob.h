// Blobs of zstd frames with a bound on their content. Private to map/.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace fovea {

std::vector<std::byte> compress_blob(std::span<const std::byte> content);
/// Nothing unless the blob is one whole zstd frame that states its content's size, which is at most
/// `largest`. Memory is taken only for what the blob can hold.
std::optional<std::vector<std::byte>> decompress_blob(std::span<const std::byte> blob,
                                                      std::size_t largest);

/// Whether a zstd frame of so many bytes can hold so much content.
bool can_hold(std::size_t frame_size, std::size_t content_size);

}  // namespace fovea
