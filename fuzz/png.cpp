// PNG images: our own decoder against libpng, behind the checksums. The first byte says what the
// rest is: a file, whose checksums are set right, or filtered rows, which are made a file of.
#include <libdeflate.h>

#include <cstring>
#include <stdexcept>
#include <vector>

#include "fovea/drive/images/png_decode.h"
#include "fovea/drive/images/png_plain_decode.h"
#include "fuzz_input.h"

using namespace fovea;

namespace {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kFrame = 12;  // bytes of a chunk around its data

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | bytes[3];
}

void put_big_endian(std::uint8_t* bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

void add_chunk(Bytes& file, const char* name, View data) {
  const std::size_t begin = file.size();
  file.resize(begin + kFrame + data.size());
  put_big_endian(&file[begin], static_cast<std::uint32_t>(data.size()));
  std::memcpy(&file[begin + 4], name, 4);
  std::copy(data.begin(), data.end(), file.begin() + std::ptrdiff_t(begin) + 8);
  put_big_endian(&file[begin + 8 + data.size()],
                 libdeflate_crc32(0, &file[begin + 4], 4 + data.size()));
}

/// The checksum at the end of the zlib stream whose bytes lie at these places of the file.
void repair_stream(Bytes& file, const std::vector<std::size_t>& places) {
  constexpr std::size_t kEnds = 6, kLargest = 1 << 20;
  if (places.size() < kEnds) return;
  Bytes zlib;
  for (const std::size_t place : places) zlib.push_back(file[place]);
  static libdeflate_decompressor* const decompressor = libdeflate_alloc_decompressor();
  static Bytes out(kLargest);
  std::size_t read = 0, written = 0;
  if (libdeflate_deflate_decompress_ex(decompressor, zlib.data() + 2, zlib.size() - 2, out.data(),
                                       out.size(), &read, &written) != LIBDEFLATE_SUCCESS ||
      read + kEnds > zlib.size()) {
    return;
  }
  std::array<std::uint8_t, 4> sum;
  put_big_endian(sum.data(), libdeflate_adler32(1, out.data(), written));
  for (std::size_t i = 0; i < sum.size(); ++i) file[places[2 + read + i]] = sum[i];
}

/// Sets right what no change of single bytes would.
void repair_checksums(Bytes& file) {
  std::vector<std::size_t> stream;
  const auto for_each_chunk = [&](auto&& f) {
    for (std::size_t at = kMagic.size(); at + kFrame <= file.size();) {
      const std::size_t length = big_endian(&file[at]);
      if (length > file.size() - at - kFrame) return;
      f(at, length);
      at += kFrame + length;
    }
  };
  for_each_chunk([&](std::size_t at, std::size_t length) {
    if (std::memcmp(&file[at + 4], "IDAT", 4) != 0) return;
    for (std::size_t i = 0; i < length; ++i) stream.push_back(at + 8 + i);
  });
  repair_stream(file, stream);
  for_each_chunk([&](std::size_t at, std::size_t length) {
    put_big_endian(&file[at + 8 + length], libdeflate_crc32(0, &file[at + 4], 4 + length));
  });
}

/// A file of the rows in `input`: width, bits, colour type, interlacing, bytes a chunk, rows.
Bytes file_of_rows(View input) {
  constexpr std::size_t kParameters = 5;
  constexpr std::uint8_t kLevel = 1;
  if (input.size() < kParameters) return {};
  const View rows = input.subspan(kParameters);
  const std::uint32_t width = input[0] + 1u;
  constexpr std::array<std::uint32_t, 7> kChannels{1, 1, 3, 1, 2, 1, 4};  // by colour type
  const std::uint8_t type = input[2] % kChannels.size();
  const std::size_t bits = std::size_t{width} * kChannels[type] * input[1];
  const std::size_t height = std::max<std::size_t>(1, rows.size() / (1 + (bits + 7) / 8));
  std::array<std::uint8_t, 13> header{};
  put_big_endian(header.data(), width);
  put_big_endian(header.data() + 4, static_cast<std::uint32_t>(height));
  header[8] = input[1];
  header[9] = type;
  header[12] = input[3];
  static libdeflate_compressor* const compressor = libdeflate_alloc_compressor(kLevel);
  Bytes zlib(libdeflate_zlib_compress_bound(compressor, rows.size()));
  zlib.resize(
      libdeflate_zlib_compress(compressor, rows.data(), rows.size(), zlib.data(), zlib.size()));
  Bytes file(kMagic.begin(), kMagic.end());
  add_chunk(file, "IHDR", header);
  const std::size_t piece = input[4] + 1u;
  for (std::size_t at = 0; at < zlib.size(); at += piece) {
    add_chunk(file, "IDAT", View(zlib).subspan(at, std::min(piece, zlib.size() - at)));
  }
  add_chunk(file, "IEND", {});
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const View input(data + 1, size - 1);
  Bytes file;
  if (data[0] % 2 == 0) {
    file.assign(input.begin(), input.end());
    repair_checksums(file);
  } else {
    file = file_of_rows(input);
  }
  const std::optional<Image> ours = decode_plain_png(file);
  std::optional<Image> theirs;
  read_or_refuse<std::runtime_error>([&] { theirs = decode_png_by_libpng(file); });
  require(!ours || theirs, "libpng takes what we take");
  require(!ours || (ours->width == theirs->width && ours->height == theirs->height &&
                    ours->channels == theirs->channels && ours->data == theirs->data),
          "libpng makes the same of it");
  if (!ours) {
    read_or_refuse<std::runtime_error>([&] {
      const Image image = decode_png(file);
      require(theirs && image.data == theirs->data, "what we do not take is libpng's");
    });
  }
  read_or_refuse<std::runtime_error>([&] {
    const Samples16 samples = decode_png_16(file);
    require(samples.data.size() == std::size_t(samples.width) * samples.height,
            "an image of 16 bits is whole");
  });
  return 0;
}
