#include "fovea/drive/images/png_decode.h"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/images/png_plain_decode.h"

namespace fovea {
namespace {

/// What libpng's callbacks reach. Outlives every longjmp, so that its members are destroyed.
struct PngInput {
  std::span<const std::uint8_t> file, rest;
  std::string error;
};

void read_from_memory(png_structp png, png_bytep out, std::size_t count) {
  auto& input = *static_cast<PngInput*>(png_get_io_ptr(png));
  if (count > input.rest.size()) png_error(png, "the file is truncated");
  std::memcpy(out, input.rest.data(), count);
  input.rest = input.rest.subspan(count);
}

[[noreturn]] void keep_error(png_structp png, png_const_charp message) {
  static_cast<PngInput*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}  // odd metadata; never of the pixels

/// Reads what comes before the samples. A damaged file must not ask for memory that it cannot fill:
/// libpng would give a note the 2 GB that its length claims.
void read_info(png_structp png, png_infop header) {
  png_set_user_limits(png, kMaxImageSide, kMaxImageSide);
  constexpr int kAllNotes = -1;  // all that pixels do not need
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, kAllNotes);
  png_read_info(png, header);
  const auto& input = *static_cast<const PngInput*>(png_get_io_ptr(png));
  const std::size_t bytes = png_get_rowbytes(png, header) * png_get_image_height(png, header);
  if (bytes > input.file.size() * kDeflateMaxRatio) {
    png_error(png, "the file is too short for its pixels");
  }
}

/// Reads the header and asks for 8-bit grey or RGB rows. Calls png_error, so holds no destructors.
void read_header(png_structp png, png_infop header) {
  read_info(png, header);
  if (png_get_bit_depth(png, header) == 16) png_error(png, "it has 16 bits a channel, not 8");
  png_set_expand(png);
  png_set_strip_alpha(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, header);
}

/// False after an error of libpng, which jumps back here; everything with a destructor belongs to
/// the caller, because the jump would skip it.
bool decode(png_structp png, png_infop header, Image& image, std::vector<png_bytep>& rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  read_header(png, header);
  image = Image(static_cast<int>(png_get_image_width(png, header)),
                static_cast<int>(png_get_image_height(png, header)),
                static_cast<int>(png_get_channels(png, header)));
  rows.resize(static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y) rows[static_cast<std::size_t>(y)] = image.pixel(0, y);
  png_read_image(png, rows.data());
  png_read_end(png, nullptr);
  return true;
}

/// As read_header, for samples of 16 bits, which a PNG file stores high byte first.
void read_header_16(png_structp png, png_infop header) {
  read_info(png, header);
  if (png_get_bit_depth(png, header) != 16 ||
      png_get_color_type(png, header) != PNG_COLOR_TYPE_GRAY) {
    png_error(png, "it has not one channel of 16 bits");
  }
  png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, header);
}

/// As decode.
bool decode_16(png_structp png, png_infop header, Samples16& samples,
               std::vector<png_bytep>& rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  read_header_16(png, header);
  samples.width = static_cast<int>(png_get_image_width(png, header));
  samples.height = static_cast<int>(png_get_image_height(png, header));
  const auto width = static_cast<std::size_t>(samples.width);
  rows.resize(static_cast<std::size_t>(samples.height));
  samples.data.resize(width * rows.size());
  for (std::size_t y = 0; y < rows.size(); ++y) {
    rows[y] = reinterpret_cast<png_bytep>(samples.data.data() + y * width);
  }
  png_read_image(png, rows.data());
  png_read_end(png, nullptr);
  return true;
}

struct PngReader {
  png_structp png;
  png_infop header;
  explicit PngReader(PngInput& input)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, &keep_error, &ignore_warning)),
        header(png != nullptr ? png_create_info_struct(png) : nullptr) {
    if (header != nullptr) png_set_read_fn(png, &input, &read_from_memory);
  }
  ~PngReader() { png_destroy_read_struct(&png, &header, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
};

}  // namespace

Image decode_png(std::span<const std::uint8_t> file) {
  std::optional<Image> image = decode_plain_png(file);
  return image ? std::move(*image) : decode_png_by_libpng(file);
}

Image decode_png_by_libpng(std::span<const std::uint8_t> file) {
  PngInput input{file, file, {}};
  PngReader reader(input);
  if (reader.header == nullptr) throw std::bad_alloc();
  Image image;
  std::vector<png_bytep> rows;
  if (!decode(reader.png, reader.header, image, rows)) throw std::runtime_error(input.error);
  return image;
}

Samples16 decode_png_16(std::span<const std::uint8_t> file) {
  static_assert(std::endian::native == std::endian::little, "samples are swapped to little endian");
  PngInput input{file, file, {}};
  PngReader reader(input);
  if (reader.header == nullptr) throw std::bad_alloc();
  Samples16 samples;
  std::vector<png_bytep> rows;
  if (!decode_16(reader.png, reader.header, samples, rows)) throw std::runtime_error(input.error);
  return samples;
}

}  // namespace fovea
