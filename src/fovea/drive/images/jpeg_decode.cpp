#include "fovea/drive/images/jpeg_decode.h"

#include <stdexcept>
#include <string>

#include "fovea/core/jpeg_errors.h"
#include "fovea/drive/images/image_decode.h"

namespace fovea {
namespace {

/// A warning (level < 0) means that pixels were made up, as after the end of a truncated file.
void fail_on_warning(j_common_ptr codec, int level) {
  if (level < 0) JpegErrors::fail(codec);
}

/// A scan of a few bytes can ask for work on every pixel, and a file can have any number of them.
/// Encoders write about ten.
constexpr int kMaxScans = 100;

void limit_scans(j_common_ptr codec) {
  if (reinterpret_cast<j_decompress_ptr>(codec)->input_scan_number <= kMaxScans) return;
  JpegErrors& errors = JpegErrors::of(codec);
  std::snprintf(errors.message, sizeof errors.message, "more than %d scans are too many",
                kMaxScans);
  std::longjmp(errors.failed, 1);
}

/// Whether a file can hold the blocks of 8 x 8 samples that its header says it has. Huffman's code
/// takes a bit at least for each.
bool is_long_enough(const jpeg_decompress_struct& codec, std::size_t bytes) {
  std::size_t blocks = 0;
  for (int i = 0; i < codec.num_components; ++i) {
    blocks += std::size_t{codec.comp_info[i].width_in_blocks} * codec.comp_info[i].height_in_blocks;
  }
  return blocks <= 8 * bytes;
}

/// False after an error, with the reason in `errors`; libjpeg jumps back here, so everything with a
/// destructor belongs to the caller.
bool decode(jpeg_decompress_struct& codec, JpegErrors& errors, std::span<const std::uint8_t> file,
            Image& image) {
  if (setjmp(errors.failed)) return false;
  jpeg_mem_src(&codec, file.data(), static_cast<unsigned long>(file.size()));
  jpeg_read_header(&codec, TRUE);
  if (codec.image_width > kMaxImageSide || codec.image_height > kMaxImageSide) {
    std::snprintf(errors.message, sizeof errors.message, "%u x %u pixels are too many",
                  codec.image_width, codec.image_height);
    return false;
  }
  // Before memory is taken.
  if (!is_long_enough(codec, file.size())) {
    std::snprintf(errors.message, sizeof errors.message, "the file is too short for its pixels");
    return false;
  }
  codec.out_color_space = codec.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_start_decompress(&codec);
  image = Image(static_cast<int>(codec.output_width), static_cast<int>(codec.output_height),
                codec.output_components);
  while (codec.output_scanline < codec.output_height) {
    JSAMPROW row = image.pixel(0, static_cast<int>(codec.output_scanline));
    jpeg_read_scanlines(&codec, &row, 1);
  }
  jpeg_finish_decompress(&codec);
  return true;
}

struct JpegReader {
  JpegErrors errors{};
  jpeg_progress_mgr progress{};
  jpeg_decompress_struct codec{};
  JpegReader() {
    codec.err = errors.start();
    errors.manager.emit_message = &fail_on_warning;
    jpeg_create_decompress(&codec);
    progress.progress_monitor = &limit_scans;
    codec.progress = &progress;
  }
  ~JpegReader() { jpeg_destroy_decompress(&codec); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
};

}  // namespace

Image decode_jpeg(std::span<const std::uint8_t> file) {
  JpegReader reader;
  Image image;
  if (!decode(reader.codec, reader.errors, file, image)) {
    throw std::runtime_error(reader.errors.message);
  }
  return image;
}

}  // namespace fovea
