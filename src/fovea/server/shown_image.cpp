#include "fovea/server/shown_image.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fovea/exporting/jpeg_encode.h"
#include "fovea/map/point_files/byte_packer.h"

namespace fovea {
namespace {

constexpr int kLiveJpegQuality = 75;
constexpr std::uint32_t kImageKind = 2;

/// Half as wide and high: the mean of four pixels.
Image halved(const Image& image) {
  Image half(std::max(image.width / 2, 1), std::max(image.height / 2, 1), image.channels);
  for (int v = 0; v < half.height; ++v) {
    const int v1 = std::min(2 * v + 1, image.height - 1);
    for (int u = 0; u < half.width; ++u) {
      const int u1 = std::min(2 * u + 1, image.width - 1);
      for (int c = 0; c < image.channels; ++c) {
        const int sum = image.pixel(2 * u, 2 * v)[c] + image.pixel(u1, 2 * v)[c] +
                        image.pixel(2 * u, v1)[c] + image.pixel(u1, v1)[c];
        half.pixel(u, v)[c] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return half;
}

}  // namespace

std::shared_ptr<const std::string> ShownImage::message() {
  std::call_once(made_, [this] {
    std::string bytes;
    BytePacker packer(bytes);
    packer.put(kImageKind);
    packer.put(static_cast<std::int32_t>(frame_));
    packer.put(static_cast<std::uint32_t>(camera_));
    const std::vector<std::uint8_t> jpeg = encode_jpeg(halved(image_), kLiveJpegQuality);
    bytes.append(jpeg.begin(), jpeg.end());
    message_ = std::make_shared<const std::string>(std::move(bytes));
    image_ = {};
  });
  return message_;
}

}  // namespace fovea
