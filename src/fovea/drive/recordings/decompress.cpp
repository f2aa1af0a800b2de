#include "fovea/drive/recordings/decompress.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <vector>

#include "fovea/core/input_file.h"
#include "fovea/core/output_file.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;

[[noreturn]] void throw_damaged(std::string_view format, std::string_view why,
                                const std::string& where) {
  throw InputError(fmt::format("{} data are damaged ({})", format, why), where,
                   "restore the recording from a copy");
}

void check_size(std::size_t size, std::size_t max_size, std::string_view format,
                const std::string& where) {
  if (size > max_size) throw_damaged(format, "they are too many", where);
}

using ZstdStream = std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)>;

ZstdStream zstd_stream() {
  ZstdStream stream(ZSTD_createDStream(), &ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  return stream;
}

/// Passes the decompressed bytes to `take`. Returns 0 at the end of a frame.
template <class Take>
std::size_t feed_zstd(ZSTD_DStream* stream, std::string_view bytes, std::vector<char>& block,
                      const std::string& where, Take&& take) {
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  std::size_t left = 1;
  bool full = false;  // more may come out without more going in
  while (in.pos < in.size || (full && left != 0)) {
    ZSTD_outBuffer out{block.data(), block.size(), 0};
    left = ZSTD_decompressStream(stream, &out, &in);
    if (ZSTD_isError(left) != 0) throw_damaged("zstd", ZSTD_getErrorName(left), where);
    take(std::string_view(block.data(), out.pos));
    full = out.pos == out.size;
  }
  return left;
}

}  // namespace

bool is_zstd(std::string_view bytes) { return bytes.starts_with("\x28\xb5\x2f\xfd"); }

std::string decompress_zstd(std::string_view bytes, std::size_t max_size,
                            const std::string& where) {
  const ZstdStream stream = zstd_stream();
  std::vector<char> block(kBlock);
  std::string result;
  const std::size_t left = feed_zstd(stream.get(), bytes, block, where, [&](std::string_view part) {
    check_size(result.size() + part.size(), max_size, "zstd", where);
    result += part;
  });
  if (left != 0) throw_damaged("zstd", "they end early", where);
  return result;
}

std::string decompress_lz4(std::string_view bytes, std::size_t max_size, const std::string& where,
                           LossyEnd end) {
  LZ4F_dctx* created = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&created, LZ4F_VERSION)) != 0) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      created, &LZ4F_freeDecompressionContext);
  std::vector<char> block(kBlock);
  std::string result;
  std::size_t left = 1;
  while (left != 0) {
    std::size_t out = block.size(), in = bytes.size();
    left = LZ4F_decompress(context.get(), block.data(), &out, bytes.data(), &in, nullptr);
    if (LZ4F_isError(left) != 0) {
      if (end == LossyEnd::kAllowed) return result;
      throw_damaged("LZ4", LZ4F_getErrorName(left), where);
    }
    if (left != 0 && in == 0 && out == 0) {
      if (end == LossyEnd::kAllowed) return result;
      throw_damaged("LZ4", "they end early", where);
    }
    check_size(result.size() + out, max_size, "LZ4", where);
    result.append(block.data(), out);
    bytes.remove_prefix(in);
  }
  return result;
}

std::string decompress_bz2(std::string_view bytes, std::size_t max_size, const std::string& where,
                           LossyEnd end) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, /*verbosity=*/0, /*small=*/0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> closed(&stream,
                                                                          &BZ2_bzDecompressEnd);
  std::vector<char> block(kBlock);
  std::string result;
  stream.next_in = const_cast<char*>(bytes.data());  // which the library only reads
  stream.avail_in = static_cast<unsigned>(bytes.size());
  for (int state = BZ_OK; state != BZ_STREAM_END;) {
    stream.next_out = block.data();
    stream.avail_out = static_cast<unsigned>(block.size());
    state = BZ2_bzDecompress(&stream);
    const std::size_t out = block.size() - stream.avail_out;
    check_size(result.size() + out, max_size, "bz2", where);
    result.append(block.data(), out);
    const bool ends_early = state == BZ_OK && out == 0 && stream.avail_in == 0;
    if (state != BZ_STREAM_END && (state != BZ_OK || ends_early)) {
      if (end == LossyEnd::kAllowed) return result;
      throw_damaged("bz2", ends_early ? "they end early" : "their content is wrong", where);
    }
  }
  return result;
}

DecompressedFile::DecompressedFile(const std::filesystem::path& file,
                                   const std::filesystem::path& folder) {
  InputFile input(file, kStreamedFile);
  std::istream& source = input.stream();
  std::string name = (folder / "decompressed_XXXXXX").string();
  const int fd = mkstemp(name.data());
  if (fd < 0) throw_output_error(name, errno);
  path_ = name;
  try {
    close(fd);
    std::ofstream target(path_, std::ios::binary);
    const ZstdStream stream = zstd_stream();
    std::vector<char> in(kBlock), block(kBlock);
    std::size_t left = 1;
    while (source.read(in.data(), std::streamsize(in.size())), source.gcount() > 0) {
      left = feed_zstd(stream.get(), {in.data(), std::size_t(source.gcount())}, block,
                       file.string(), [&](std::string_view part) {
                         errno = 0;
                         target.write(part.data(), std::streamsize(part.size()));
                         if (!target) throw_output_error(path_, errno);
                       });
    }
    if (left != 0) throw_damaged("zstd", "they end early", file.string());
    target.close();
    if (!target) throw_output_error(path_, errno);
  } catch (...) {
    unlink(path_.c_str());
    throw;
  }
}

DecompressedFile::~DecompressedFile() { unlink(path_.c_str()); }

}  // namespace fovea
