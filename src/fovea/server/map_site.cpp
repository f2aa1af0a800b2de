#include "fovea/server/map_site.h"

#include <array>
#include <charconv>
#include <utility>

#include "fovea/exporting/jpeg_encode.h"

namespace fovea {
namespace {

using Bytes = SiteContent::Bytes;

constexpr const char* kJson = "application/json";
constexpr int kPhotographJpegQuality = 90;

WebResponse not_found() { return refusal(404, "there is no such thing here"); }

/// A number that is all of the text.
std::optional<int> number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string media_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, const char*>, 8> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", kJson},
      {".glb", "model/gltf-binary"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
  }};
  for (const auto& [ending, type] : kTypes) {
    if (name.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

WebResponse page_response(std::span<const PageFile> page, const std::string& path) {
  const std::string_view wanted = path.empty() ? std::string_view("index.html") : path;
  for (const PageFile& file : page) {
    if (file.name == wanted)
      return {200, media_type(wanted), shared_bytes(std::string(file.bytes))};
  }
  return not_found();
}

WebResponse DriveImages::response(std::string_view path) const {
  constexpr std::string_view kEnding = ".jpg";
  if (!has(path)) return not_found();
  path.remove_prefix(kFolder.size());
  const std::size_t slash = path.find('/');
  if (slash == std::string_view::npos || !path.ends_with(kEnding)) return not_found();
  const std::optional<int> frame = number(path.substr(0, slash));
  const std::optional<int> camera =
      number(path.substr(slash + 1, path.size() - slash - 1 - kEnding.size()));
  if (!frame || !camera || *frame < info().begin || *frame >= info().end) return not_found();
  const LoadedFrame loaded = drive_->load(*frame);
  const auto* of_drive = std::get_if<Frame>(&loaded);
  if (of_drive == nullptr) return not_found();
  const std::vector<Camera>& cameras = info().calibration.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].index != *camera || of_drive->images[i].empty()) continue;
    const std::vector<std::uint8_t> jpeg = encode_jpeg(of_drive->images[i], kPhotographJpegQuality);
    return {200, "image/jpeg", shared_bytes(std::string(jpeg.begin(), jpeg.end()))};
  }
  return not_found();
}

void MapSite::answer(const std::string& path, WebServer::Reply reply) {
  if (images_ && DriveImages::has(path)) return reply(images_->response(path));
  content_->request(
      path, [this, path, reply = std::move(reply)](const Bytes& file, const std::string& failure) {
        if (!failure.empty()) return reply(refusal(500, failure));
        if (!file) return reply(page_response(page_, path));
        reply({200, media_type(path), file});
      });
}

}  // namespace fovea
