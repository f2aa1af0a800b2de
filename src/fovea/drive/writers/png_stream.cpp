#include "fovea/drive/writers/png_stream.h"

#include <png.h>

#include <csetjmp>
#include <exception>
#include <stdexcept>
#include <string>

namespace fovea {

struct PngStream::State {
  std::ostream* stream = nullptr;
  int width = 0, rows_left = 0;
  std::string message;       // of libpng
  std::exception_ptr error;  // of the stream
  png_structp png = nullptr;
  png_infop header = nullptr;

  ~State() { png_destroy_write_struct(&png, &header); }
  /// Throws the error that made libpng jump back.
  [[noreturn]] void fail() const {
    if (error) std::rethrow_exception(error);
    throw std::runtime_error("a picture cannot be packed: " + message);
  }
};

namespace {

constexpr int kCompression = 6;  // of 9: large areas are transparent

/// Calls of libpng with its errors; false after one. The callers own everything with a destructor,
/// because the jump would skip it.
bool write_header(png_structp png, png_infop header, int width, int height) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_compression_level(png, kCompression);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, header, png_uint_32(width), png_uint_32(height), 8, PNG_COLOR_TYPE_RGB_ALPHA,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, header);
  return true;
}

bool write_row(png_structp png, const std::uint8_t* row) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_write_row(png, row);
  return true;
}

bool write_end(png_structp png) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_write_end(png, nullptr);
  return true;
}

void ignore_warning(png_structp, png_const_charp) {}

}  // namespace

PngStream::PngStream(std::ostream& stream, int width, int height)
    : state_(std::make_unique<State>()) {
  if (width <= 0 || height <= 0) throw std::invalid_argument("a picture has no pixels");
  State& state = *state_;
  state.stream = &stream;
  state.width = width;
  state.rows_left = height;
  const auto keep_message = [](png_structp png, png_const_charp message) {
    static_cast<State*>(png_get_error_ptr(png))->message = message;
    png_longjmp(png, 1);
  };
  const auto write_bytes = [](png_structp png, png_bytep data, std::size_t count) {
    auto& to = *static_cast<State*>(png_get_io_ptr(png));
    try {
      to.stream->write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(count));
    } catch (...) {  // must not fly through C
      to.error = std::current_exception();
    }
    if (to.error) png_error(png, "the stream failed");
  };
  state.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, keep_message, ignore_warning);
  if (state.png != nullptr) state.header = png_create_info_struct(state.png);
  if (state.header == nullptr) throw std::bad_alloc();
  png_set_write_fn(state.png, &state, write_bytes, nullptr);
  if (!write_header(state.png, state.header, width, height)) state.fail();
}

PngStream::~PngStream() = default;

void PngStream::put_row(std::span<const std::uint8_t> rgba) {
  State& state = *state_;
  if (rgba.size() != 4 * static_cast<std::size_t>(state.width)) {
    throw std::invalid_argument("a row has another width than its picture");
  }
  if (state.rows_left == 0) throw std::logic_error("a picture has more rows than stated");
  if (!write_row(state.png, rgba.data())) state.fail();
  --state.rows_left;
}

void PngStream::finish() {
  const State& state = *state_;
  if (state.rows_left > 0) throw std::logic_error("rows of a picture are missing");
  if (!write_end(state.png)) state.fail();
}

}  // namespace fovea
