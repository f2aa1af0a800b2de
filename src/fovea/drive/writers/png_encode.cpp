#include "fovea/drive/writers/png_encode.h"

#include <png.h>

#include <csetjmp>
#include <new>
#include <stdexcept>
#include <string>

namespace fovea {
namespace {

/// What libpng's callbacks reach. Outlives every longjmp, so that its members are destroyed.
struct PngOutput {
  std::vector<std::uint8_t> bytes;
  std::string error;
};

/// What a file holds, row by row, and how it is packed.
struct PngContent {
  int width = 0, height = 0;
  int color_type = PNG_COLOR_TYPE_GRAY;
  int bits = 8;
  int filter = PNG_NO_FILTERS;  ///< one that suits the content: trying all for every row costs most
  std::vector<const std::uint8_t*> rows;
};

void append_to_memory(png_structp png, png_bytep data, std::size_t count) {
  auto& output = *static_cast<PngOutput*>(png_get_io_ptr(png));
  try {
    output.bytes.insert(output.bytes.end(), data, data + count);
  } catch (const std::bad_alloc&) {  // must not fly through C
    png_error(png, "out of memory");
  }
}

[[noreturn]] void keep_error(png_structp png, png_const_charp message) {
  static_cast<PngOutput*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

/// False after an error of libpng, which jumps back here; everything with a destructor belongs to
/// the caller, because the jump would skip it.
bool encode(png_structp png, png_infop header, const PngContent& content) {
  if (setjmp(png_jmpbuf(png))) return false;
  constexpr int kCompression = 3;  // of 9
  png_set_compression_level(png, kCompression);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, content.filter);
  png_set_IHDR(png, header, png_uint_32(content.width), png_uint_32(content.height), content.bits,
               content.color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, header);
  for (const std::uint8_t* row : content.rows) png_write_row(png, row);
  png_write_end(png, nullptr);
  return true;
}

std::vector<std::uint8_t> encode(const PngContent& content) {
  PngOutput output;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, keep_error, ignore_warning);
  png_infop header = png != nullptr ? png_create_info_struct(png) : nullptr;
  bool done = false;
  if (header != nullptr) {
    png_set_write_fn(png, &output, append_to_memory, nullptr);
    done = encode(png, header, content);
  }
  png_destroy_write_struct(&png, &header);
  if (!done) throw std::runtime_error("an image cannot be packed: " + output.error);
  return std::move(output.bytes);
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
  if (image.empty()) throw std::invalid_argument("an empty image cannot be written");
  PngContent content;
  content.width = image.width;
  content.height = image.height;
  if (image.channels == 3) content.color_type = PNG_COLOR_TYPE_RGB;
  content.filter = PNG_FILTER_SUB;
  for (int y = 0; y < image.height; ++y) content.rows.push_back(image.pixel(0, y));
  return encode(content);
}

std::vector<std::uint8_t> encode_png_16(int width, int height,
                                        const std::vector<std::uint16_t>& values) {
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (count == 0 || values.size() != count) {
    throw std::invalid_argument("a 16-bit image has another size than its values");
  }
  std::vector<std::uint8_t> big_endian;
  big_endian.reserve(2 * count);
  for (const std::uint16_t value : values) {
    big_endian.push_back(static_cast<std::uint8_t>(value >> 8));
    big_endian.push_back(static_cast<std::uint8_t>(value & 0xff));
  }
  PngContent content;
  content.width = width;
  content.height = height;
  content.bits = 16;
  content.filter = PNG_FILTER_UP;
  for (int y = 0; y < height; ++y) {
    content.rows.push_back(big_endian.data() + 2 * static_cast<std::size_t>(y) * width);
  }
  return encode(content);
}

}  // namespace fovea
