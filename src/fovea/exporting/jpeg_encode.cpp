#include "fovea/exporting/jpeg_encode.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "fovea/core/jpeg_errors.h"

namespace fovea {
namespace {

/// What a jump must not lose.
struct JpegWriter {
  JpegErrors errors{};
  jpeg_compress_struct codec{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  JpegWriter() {
    codec.err = errors.start();
    jpeg_create_compress(&codec);
  }
  ~JpegWriter() {
    jpeg_destroy_compress(&codec);
    std::free(bytes);
  }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;
};

/// False after an error, with the reason in the writer.
bool encode(JpegWriter& writer, const Image& image, int quality) {
  if (setjmp(writer.errors.failed)) return false;
  jpeg_compress_struct& codec = writer.codec;
  jpeg_mem_dest(&codec, &writer.bytes, &writer.size);
  codec.image_width = static_cast<JDIMENSION>(image.width);
  codec.image_height = static_cast<JDIMENSION>(image.height);
  codec.input_components = image.channels;
  codec.in_color_space = image.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, quality, TRUE);
  codec.comp_info[0].h_samp_factor = codec.comp_info[0].v_samp_factor = 1;
  codec.optimize_coding = TRUE;
  jpeg_start_compress(&codec, TRUE);
  while (codec.next_scanline < codec.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(image.pixel(0, static_cast<int>(codec.next_scanline)));
    jpeg_write_scanlines(&codec, &row, 1);
  }
  jpeg_finish_compress(&codec);
  return true;
}

}  // namespace

std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality) {
  if (image.empty()) throw std::invalid_argument("an empty image cannot be written");
  if (quality < 1 || quality > 100) throw std::invalid_argument("a JPEG quality is 1 to 100");
  JpegWriter writer;
  if (!encode(writer, image, quality)) {
    throw std::runtime_error(std::string("an image cannot be packed: ") + writer.errors.message);
  }
  return {writer.bytes, writer.bytes + writer.size};
}

}  // namespace fovea
