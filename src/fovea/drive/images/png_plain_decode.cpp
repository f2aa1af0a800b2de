#include "fovea/drive/images/png_plain_decode.h"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/images/png_unfilter.h"

namespace fovea {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kFrame = 12;  // bytes of a chunk around its data: length, name, checksum
/// Longer notes than this libpng may refuse.
constexpr std::size_t kLongestNote = 1 << 16;

std::uint32_t big_endian(Bytes bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | bytes[3];
}

constexpr std::uint32_t name(const char (&letters)[5]) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(letters[i]);
  return value;
}

struct Chunk {
  std::uint32_t name;
  Bytes data;
};

/// Takes the first chunk off `rest`; empty if it is not whole.
std::optional<Chunk> take_chunk(Bytes& rest) {
  if (rest.size() < kFrame) return std::nullopt;
  const std::size_t length = big_endian(rest);
  if (length > rest.size() - kFrame) return std::nullopt;
  const Bytes checked = rest.subspan(4, 4 + length);
  if (libdeflate_crc32(0, checked.data(), checked.size()) != big_endian(rest.subspan(8 + length))) {
    return std::nullopt;
  }
  rest = rest.subspan(kFrame + length);
  return Chunk{big_endian(checked), checked.subspan(4)};
}

/// Whether a chunk may be left unread: a lower-case first letter says so, and no transparency.
bool is_note(const Chunk& chunk) {
  for (int shift = 0; shift < 32; shift += 8) {
    const std::uint32_t letter = (chunk.name >> shift & 0xff) | 0x20;
    if (letter < 'a' || letter > 'z') return false;
  }
  return (chunk.name >> 29 & 1) != 0 && chunk.name != name("tRNS") &&
         chunk.data.size() <= kLongestNote;
}

struct Header {
  int width = 0, height = 0;
  int stored_channels = 0;  // alpha included
  int channels() const { return stored_channels < 3 ? 1 : 3; }
  std::size_t row_bytes() const { return static_cast<std::size_t>(width) * stored_channels; }
  /// Of all rows, each with the byte that names its filter.
  std::size_t filtered_bytes() const { return (1 + row_bytes()) * height; }
};

std::optional<Header> read_header(const Chunk& chunk) {
  if (chunk.name != name("IHDR") || chunk.data.size() != 13) return std::nullopt;
  const std::uint32_t width = big_endian(chunk.data), height = big_endian(chunk.data.subspan(4));
  const std::uint8_t bits = chunk.data[8], color_type = chunk.data[9];
  const bool plain_methods = (chunk.data[10] | chunk.data[11] | chunk.data[12]) == 0;
  constexpr std::array<int, 7> kChannels{1, 0, 3, 0, 2, 0, 4};  // by colour type; 3: a palette
  if (width == 0 || height == 0 || width > kMaxImageSide || height > kMaxImageSide || bits != 8 ||
      color_type >= kChannels.size() || kChannels[color_type] == 0 || !plain_methods) {
    return std::nullopt;
  }
  return Header{static_cast<int>(width), static_cast<int>(height), kChannels[color_type]};
}

/// Reads all chunks: one header, then samples one after another, in any number of pieces.
/// @param zlib  gets the samples as they are compressed
std::optional<Header> read_chunks(Bytes file, std::vector<std::uint8_t>& zlib) {
  if (file.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), file.begin())) {
    return std::nullopt;
  }
  Bytes rest = file.subspan(kMagic.size());
  const auto first = take_chunk(rest);
  if (!first) return std::nullopt;
  const auto header = read_header(*first);
  if (!header) return std::nullopt;
  zlib.reserve(rest.size());
  bool samples = false, samples_end = false;
  while (const auto chunk = take_chunk(rest)) {
    if (chunk->name == name("IDAT")) {
      if (samples_end) return std::nullopt;
      samples = true;
      zlib.insert(zlib.end(), chunk->data.begin(), chunk->data.end());
    } else if (chunk->name == name("IEND")) {
      return chunk->data.empty() ? header : std::nullopt;
    } else if (!is_note(*chunk)) {
      return std::nullopt;
    } else {
      samples_end = samples;
    }
  }
  return std::nullopt;
}

/// Decompresses exactly `out.size()` bytes, with their checksum.
bool inflate(std::vector<std::uint8_t>& zlib, std::span<std::uint8_t> out) {
  // A window that is declared smaller than the image is left to libpng, which knows what is wrong.
  const std::size_t window = zlib.empty() ? 0 : std::size_t{256} << (zlib[0] >> 4);
  if (window < std::min<std::size_t>(out.size(), 1 << 15)) return false;
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (zlib.size() > kMost || out.size() > kMost) return false;
  const auto state = std::make_unique_for_overwrite<inflate_state>();  // of 90 kB
  isal_inflate_init(state.get());
  state->crc_flag = ISAL_ZLIB;
  state->next_in = zlib.data();
  state->avail_in = static_cast<std::uint32_t>(zlib.size());
  state->next_out = out.data();
  state->avail_out = static_cast<std::uint32_t>(out.size());
  return isal_inflate_stateless(state.get()) == ISAL_DECOMP_OK &&
         state->block_state == ISAL_BLOCK_FINISH && state->avail_out == 0 && state->avail_in == 0;
}

/// Copies a row without its alpha.
void copy_row(const std::uint8_t* row, const Header& header, std::uint8_t* out) {
  const int stored = header.stored_channels, kept = header.channels();
  if (stored == kept) {
    std::memmove(out, row, header.row_bytes());
    return;
  }
  for (int x = 0; x < header.width; ++x, row += stored, out += kept) {
    for (int c = 0; c < kept; ++c) out[c] = row[c];
  }
}

/// Turns filtered rows into an image's, in place. The row above must stay as it was stored until
/// the next one has been unfiltered: each is copied to its place, which lies before, one later.
bool unfilter_rows(const Header& header, std::vector<std::uint8_t>& data) {
  const std::size_t stride = header.row_bytes();
  const std::size_t kept = static_cast<std::size_t>(header.width) * header.channels();
  const std::vector<std::uint8_t> nothing(stride, 0);
  const std::uint8_t* above = nothing.data();
  for (std::size_t y = 0; y < static_cast<std::size_t>(header.height); ++y) {
    std::uint8_t* row = data.data() + y * (1 + stride) + 1;
    if (!unfilter_row(row[-1], header.stored_channels, row, stride, above)) return false;
    if (y > 0) copy_row(above, header, data.data() + (y - 1) * kept);
    above = row;
  }
  copy_row(above, header, data.data() + static_cast<std::size_t>(header.height - 1) * kept);
  data.resize(kept * static_cast<std::size_t>(header.height));
  return true;
}

}  // namespace

std::optional<Image> decode_plain_png(Bytes file) {
  std::vector<std::uint8_t> zlib;
  const std::optional<Header> header = read_chunks(file, zlib);
  // Before memory is taken: a damaged header must not ask for what the file cannot fill.
  if (!header || header->filtered_bytes() > zlib.size() * kDeflateMaxRatio) return std::nullopt;
  Image image;
  image.width = header->width;
  image.height = header->height;
  image.channels = header->channels();
  image.data.resize(header->filtered_bytes());
  if (!inflate(zlib, image.data) || !unfilter_rows(*header, image.data)) return std::nullopt;
  return image;
}

}  // namespace fovea
