// Compressed parts of recordings. Memory is taken as data come out, whatever a damaged header says.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace fovea {

/// Most bytes that one message or chunk may have.
inline constexpr std::size_t kMaxBagBlock = std::size_t{1} << 28;

/// Whether bytes begin as a frame of zstd does; no CDR message begins so.
bool is_zstd(std::string_view bytes);

/// Whether data may end early: then what comes before the end is returned.
enum class LossyEnd { kRefused, kAllowed };

/// One frame of zstd or of LZ4, or one stream of bz2. InputError that names `where` for damaged
/// data and for more than `max_size` bytes.
std::string decompress_zstd(std::string_view bytes, std::size_t max_size, const std::string& where);
std::string decompress_lz4(std::string_view bytes, std::size_t max_size, const std::string& where,
                           LossyEnd end = LossyEnd::kRefused);
std::string decompress_bz2(std::string_view bytes, std::size_t max_size, const std::string& where,
                           LossyEnd end = LossyEnd::kRefused);

/// What a file compressed by zstd holds, as a file in `folder`, which is removed with the object.
class DecompressedFile {
 public:
  /// InputError for a file that is damaged or cut short, OutputError where the disk is full.
  DecompressedFile(const std::filesystem::path& file, const std::filesystem::path& folder);
  ~DecompressedFile();
  DecompressedFile(const DecompressedFile&) = delete;
  DecompressedFile& operator=(const DecompressedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace fovea
