#include "app/html_report/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/drive/writers/png_encode.h"
#include "fovea/exporting/jpeg_encode.h"

namespace fovea::app {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// Bytes of the UTF-8 character that starts here; 0 if none does.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  if (length < 3) return length;
  // Overlong forms, surrogates, what lies beyond Unicode, and the two non-characters U+FFFE/F.
  const unsigned char second = byte(1);
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;
  if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;
  if (first == 0xEF && second == 0xBF && byte(2) >= 0xBE) return 0;
  return length;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const char c = text.front();
    if (length == 0 || (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t')) {
      safe += kReplacement;
    } else if (c == '&') {
      safe += "&amp;";
    } else if (c == '<') {
      safe += "&lt;";
    } else if (c == '>') {
      safe += "&gt;";
    } else if (c == '"') {
      safe += "&quot;";
    } else {
      safe += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return safe;
}

std::string number(double value, int digits) {
  if (std::isnan(value)) return "none";
  if (std::isinf(value)) return value > 0 ? "infinite" : "-infinite";
  return fmt::format("{:.{}g}", value, digits);
}

std::string count(std::size_t value) {
  std::string digits = std::to_string(value);
  for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3) {
    digits.insert(static_cast<std::size_t>(at), "\xE2\x80\xAF");
  }
  return digits;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < given ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= given ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

Image shrunk(const Image& image, int width) {
  if (image.width <= width) return image;
  const int height = std::max(1, image.height * width / image.width);
  Image small(width, height, image.channels);
  for (int y = 0; y < height; ++y) {
    const int top = y * image.height / height, bottom = (y + 1) * image.height / height;
    for (int x = 0; x < width; ++x) {
      const int left = x * image.width / width, right = (x + 1) * image.width / width;
      for (int c = 0; c < image.channels; ++c) {
        int sum = 0;
        for (int v = top; v < bottom; ++v) {
          for (int u = left; u < right; ++u) sum += image.pixel(u, v)[c];
        }
        const int pixels = (bottom - top) * (right - left);
        small.pixel(x, y)[c] = static_cast<std::uint8_t>((sum + pixels / 2) / pixels);
      }
    }
  }
  return small;
}

std::string jpeg_uri(const Image& image, int quality) {
  return "data:image/jpeg;base64," + base64(encode_jpeg(shrunk(image, kMaxPictureWidth), quality));
}

std::string png_uri(const Image& image) {
  return "data:image/png;base64," + base64(encode_png(image));
}

}  // namespace fovea::app
