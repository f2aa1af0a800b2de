#include "fovea/server/frame_images.h"

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fovea/exporting/jpeg_encode.h"

namespace fovea {
namespace {

constexpr int kPhotographJpegQuality = 90;

/// A number that is all of the text.
std::optional<int> number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

WebResponse FrameImages::no_image() { return refusal(404, "there is no such thing here"); }

WebResponse FrameImages::response(std::string_view path) const {
  constexpr std::string_view kEnding = ".jpg";
  if (!has(path)) return no_image();
  path.remove_prefix(kFolder.size());
  const std::size_t slash = path.find('/');
  if (slash == std::string_view::npos || !path.ends_with(kEnding)) return no_image();
  const std::optional<int> frame = number(path.substr(0, slash));
  const std::optional<int> camera =
      number(path.substr(slash + 1, path.size() - slash - 1 - kEnding.size()));
  if (!frame || !camera) return no_image();
  return image(*frame, *camera);
}

WebResponse DriveImages::image(int frame, int camera) const {
  if (frame < info().begin || frame >= info().end) return no_image();
  const LoadedFrame loaded = drive_->load(frame);
  const auto* of_drive = std::get_if<Frame>(&loaded);
  if (of_drive == nullptr) return no_image();
  const std::vector<Camera>& cameras = info().calibration.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].index != camera || of_drive->images[i].empty()) continue;
    return photograph_response(photograph_jpeg(of_drive->images[i]));
  }
  return no_image();
}

std::shared_ptr<const std::string> photograph_jpeg(const Image& image) {
  const std::vector<std::uint8_t> jpeg = encode_jpeg(image, kPhotographJpegQuality);
  return std::make_shared<const std::string>(jpeg.begin(), jpeg.end());
}

WebResponse photograph_response(std::shared_ptr<const std::string> jpeg) {
  return {200, "image/jpeg", std::move(jpeg)};
}

}  // namespace fovea
