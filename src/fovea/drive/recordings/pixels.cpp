#include "fovea/drive/recordings/pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fovea/drive/images/image_decode.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

enum class Layout { kChannels, kBayer, kYuv };

struct Encoding {
  std::string_view name;
  Layout layout;
  int bytes;  // of a pixel
  /// Channels: where red, green and blue (or grey alone) lie. Bayer: which of the three the
  /// corner's four pixels show. YUV: where the first of two brightnesses, U and V lie in four
  /// bytes.
  std::array<int, 4> order;
};

constexpr std::array kEncodings = {
    Encoding{"mono8", Layout::kChannels, 1, {0, -1}},
    Encoding{"8UC1", Layout::kChannels, 1, {0, -1}},
    Encoding{"rgb8", Layout::kChannels, 3, {0, 1, 2}},
    Encoding{"bgr8", Layout::kChannels, 3, {2, 1, 0}},
    Encoding{"8UC3", Layout::kChannels, 3, {2, 1, 0}},
    Encoding{"rgba8", Layout::kChannels, 4, {0, 1, 2}},
    Encoding{"bgra8", Layout::kChannels, 4, {2, 1, 0}},
    Encoding{"8UC4", Layout::kChannels, 4, {2, 1, 0}},
    Encoding{"bayer_rggb8", Layout::kBayer, 1, {0, 1, 1, 2}},
    Encoding{"bayer_bggr8", Layout::kBayer, 1, {2, 1, 1, 0}},
    Encoding{"bayer_gbrg8", Layout::kBayer, 1, {1, 2, 0, 1}},
    Encoding{"bayer_grbg8", Layout::kBayer, 1, {1, 0, 2, 1}},
    Encoding{"yuv422", Layout::kYuv, 2, {1, 0, 2}},
    Encoding{"uyvy", Layout::kYuv, 2, {1, 0, 2}},
    Encoding{"yuv422_yuy2", Layout::kYuv, 2, {0, 1, 3}},
    Encoding{"yuyv", Layout::kYuv, 2, {0, 1, 3}},
};

const Encoding* find_encoding(std::string_view name) {
  const auto found = std::find_if(kEncodings.begin(), kEncodings.end(),
                                  [&](const Encoding& encoding) { return encoding.name == name; });
  return found == kEncodings.end() ? nullptr : &*found;
}

/// Bytes of an image by place.
class Bytes {
 public:
  Bytes(const ros::ImageMessage& message, int pixel_bytes)
      : data_(reinterpret_cast<const std::uint8_t*>(message.data.data())),
        step_(message.step),
        pixel_bytes_(pixel_bytes) {}
  const std::uint8_t* at(int x, int y) const {
    return data_ + std::size_t(y) * step_ + std::size_t(x) * std::size_t(pixel_bytes_);
  }

 private:
  const std::uint8_t* data_;
  std::size_t step_;
  int pixel_bytes_;
};

Image from_channels(const Bytes& bytes, const Encoding& encoding, Image image) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        image.pixel(x, y)[c] = bytes.at(x, y)[encoding.order[std::size_t(c)]];
      }
    }
  }
  return image;
}

/// Each colour is the mean of its samples among the pixel's neighbours, or the pixel's own.
Image from_bayer(const Bytes& bytes, const Encoding& encoding, Image image) {
  const auto channel = [&](int x, int y) {
    return encoding.order[std::size_t(2 * (y % 2) + x % 2)];
  };
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::array<int, 3> sum{}, count{};
      for (int v = std::max(0, y - 1); v <= std::min(image.height - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(image.width - 1, x + 1); ++u) {
          const auto c = std::size_t(channel(u, v));
          sum[c] += *bytes.at(u, v), ++count[c];
        }
      }
      const auto own = std::size_t(channel(x, y));
      sum[own] = *bytes.at(x, y), count[own] = 1;
      for (std::size_t c = 0; c < 3; ++c) {
        image.pixel(x, y)[c] =
            static_cast<std::uint8_t>(count[c] == 0 ? 0 : (2 * sum[c] + count[c]) / (2 * count[c]));
      }
    }
  }
  return image;
}

/// ITU-R BT.601 with brightnesses of 16 to 235, as cameras on USB send.
Image from_yuv(const Bytes& bytes, const Encoding& encoding, Image image) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* pair = bytes.at(x / 2 * 2, y);
      const float luma = 1.164f * float(pair[encoding.order[0] + 2 * (x % 2)] - 16);
      const float u = float(pair[encoding.order[1]] - 128),
                  v = float(pair[encoding.order[2]] - 128);
      const Rgb color = to_rgb(
          Eigen::Vector3f{luma + 1.596f * v, luma - 0.392f * u - 0.813f * v, luma + 2.017f * u});
      std::uint8_t* pixel = image.pixel(x, y);
      pixel[0] = color.r, pixel[1] = color.g, pixel[2] = color.b;
    }
  }
  return image;
}

}  // namespace

bool is_known_encoding(std::string_view encoding) { return find_encoding(encoding) != nullptr; }

Image image_of(const ros::ImageMessage& message, const std::string& where) {
  const Encoding* encoding = find_encoding(message.encoding);
  if (encoding == nullptr) {
    throw InputError(fmt::format("images of encoding '{:.40}' are not read", message.encoding),
                     where, "see docs/drives.md for those that are");
  }
  const std::uint64_t row = std::uint64_t{message.width} * std::uint64_t(encoding->bytes);
  const bool possible = message.width >= 1 && message.height >= 1 &&
                        message.width <= kMaxImageSide && message.height <= kMaxImageSide &&
                        (encoding->layout != Layout::kYuv || message.width % 2 == 0);
  if (!possible || row > message.step ||
      std::uint64_t{message.step} * (message.height - 1) + row > message.data.size()) {
    throw InputError("an image has fewer bytes than its pixels take, or impossible sides", where,
                     "restore the recording from a copy");
  }
  const bool grey = encoding->layout == Layout::kChannels && encoding->order[1] < 0;
  Image image(int(message.width), int(message.height), grey ? 1 : 3);
  const Bytes bytes(message, encoding->bytes);
  switch (encoding->layout) {
    case Layout::kChannels:
      return from_channels(bytes, *encoding, std::move(image));
    case Layout::kBayer:
      return from_bayer(bytes, *encoding, std::move(image));
    case Layout::kYuv:
      return from_yuv(bytes, *encoding, std::move(image));
  }
  return image;
}

std::string_view extension_of(const ros::CompressedImage& image, const std::string& where) {
  if (is_png(image.data)) return ".png";
  if (is_jpeg(image.data)) return ".jpg";
  throw InputError(fmt::format("images of format '{:.40}' are not read", image.format), where,
                   "record PNG or JPEG");
}

}  // namespace fovea
