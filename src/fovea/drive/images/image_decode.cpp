#include "fovea/drive/images/image_decode.h"

#include <algorithm>
#include <stdexcept>

#include "fovea/core/file_format.h"
#include "fovea/core/read_file.h"
#include "fovea/drive/images/jpeg_decode.h"
#include "fovea/drive/images/png_decode.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr const char* kRemedy = "restore the file from the drive's archive";

}  // namespace

Image read_image(const std::filesystem::path& file) {
  return decode_image(read_bytes(file, kImageFile), file.string());
}

Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
  const SniffedFormat found = sniff_format(
      {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kSniffedBytes)});
  const bool png = found.format == FileFormat::kPng;
  if (!png && found.format != FileFormat::kJpeg) {
    throw InputError("the file is neither a PNG nor a JPEG image, but " + std::string(found.name),
                     name, kRemedy);
  }
  try {
    return png ? decode_png(bytes) : decode_jpeg(bytes);
  } catch (const std::runtime_error& error) {
    throw InputError(
        std::string(png ? "the PNG" : "the JPEG") + " image cannot be read (" + error.what() + ")",
        name, kRemedy);
  }
}

DepthImage read_depth_image(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file, kImageFile);
  DepthImage image;
  try {
    const Samples16 samples = decode_png_16(bytes);
    image.width = samples.width;
    image.height = samples.height;
    image.depth.reserve(samples.data.size());
    for (const std::uint16_t sample : samples.data) {
      image.depth.push_back(static_cast<float>(sample) / 256.0f);
    }
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("the depth map cannot be read (") + error.what() + ")",
                     file.string(), kRemedy);
  }
  return image;
}

}  // namespace fovea
