#include "fovea/sensor/image_decode.h"

#include <array>
#include <stdexcept>

#include "fovea/base/errors.h"
#include "fovea/sensor/jpeg_decode.h"
#include "fovea/sensor/png_decode.h"
#include "fovea/sensor/read_file.h"

namespace fovea {
namespace {

constexpr std::array<std::uint8_t, 8> kPngMagic{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::array<std::uint8_t, 3> kJpegMagic{0xff, 0xd8, 0xff};

template <std::size_t N>
bool starts_with(const std::vector<std::uint8_t>& bytes, const std::array<std::uint8_t, N>& magic) {
  return bytes.size() >= N && std::equal(magic.begin(), magic.end(), bytes.begin());
}

constexpr const char* kRemedy = "restore the file from the drive's archive";

}  // namespace

Image read_image(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  const bool png = starts_with(bytes, kPngMagic);
  if (!png && !starts_with(bytes, kJpegMagic)) {
    throw InputError("the file is neither a PNG nor a JPEG image", file.string(), kRemedy);
  }
  try {
    return png ? decode_png(bytes) : decode_jpeg(bytes);
  } catch (const std::runtime_error& error) {
    throw InputError(
        std::string(png ? "the PNG" : "the JPEG") + " image cannot be read (" + error.what() + ")",
        file.string(), kRemedy);
  }
}

DepthImage read_depth_image(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
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
