#include "fovea/server/map_site.h"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/exporting/jpeg_encode.h"
#include "fovea/exporting/viewer/map_description.h"

namespace fovea {
namespace {

using Bytes = std::shared_ptr<const std::string>;

constexpr std::string_view kTiles = "tiles/", kTileEnding = ".glb";
constexpr const char* kJson = "application/json";
constexpr int kPhotographJpegQuality = 90;

Bytes bytes(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

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
    if (file.name == wanted) return {200, media_type(wanted), bytes(std::string(file.bytes))};
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
    return {200, "image/jpeg", bytes(std::string(jpeg.begin(), jpeg.end()))};
  }
  return not_found();
}

MapSite::MapSite(const std::filesystem::path& map, std::span<const PageFile> page,
                 std::shared_ptr<const DriveImages> images, const ExposureChoice& exposure)
    : page_(page), images_(std::move(images)), tiles_(map, exposure) {
  const MapReader reader(map);
  MapDescription description = describe_map(reader);
  description.tileset = "tiles/tileset.json";
  description.status = true;
  if (images_) {
    description.images = true;
    description.cameras = images_->info().calibration.cameras;
    description.sensor_period = images_->info().sweep.period;
  }
  map_json_ = bytes(to_json(description));
  frames_json_ = bytes(frames_json(reader.frames()).dump());
}

std::string MapSite::status_json() const {
  nlohmann::json json = {{"state", tiles_.read() < 1 ? "reading" : "ready"},
                         {"read", tiles_.read()}};
  const std::string failure = tiles_.failure();
  if (!failure.empty()) json["failure"] = failure;
  return json.dump();
}

void MapSite::answer(const std::string& path, WebServer::Reply reply) {
  if (path == "map.json") return reply({200, kJson, map_json_});
  if (path == "frames.json") return reply({200, kJson, frames_json_});
  if (path == "status.json") return reply({200, kJson, bytes(status_json())});
  if (path == "tiles/tileset.json") return reply({200, kJson, tiles_.tileset()});
  if (path.starts_with(kTiles) && path.ends_with(kTileEnding)) {
    const std::string name =
        path.substr(kTiles.size(), path.size() - kTiles.size() - kTileEnding.size());
    return tiles_.request(
        name, [reply = std::move(reply)](const Bytes& tile, const std::string& failure) {
          if (!failure.empty()) return reply(refusal(500, failure));
          if (!tile) return reply(not_found());
          reply({200, media_type(kTileEnding), tile});
        });
  }
  if (images_ && DriveImages::has(path)) return reply(images_->response(path));
  reply(page_response(page_, path));
}

}  // namespace fovea
