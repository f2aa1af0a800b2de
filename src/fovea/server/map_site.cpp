#include "fovea/server/map_site.h"

#include <array>
#include <utility>

namespace fovea {
namespace {

using Bytes = SiteContent::Bytes;

constexpr const char* kJson = "application/json";

WebResponse not_found() { return refusal(404, "there is no such thing here"); }

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

void MapSite::answer(const std::string& path, WebServer::Reply reply) {
  if (images_ && FrameImages::has(path)) return reply(images_->response(path));
  content_->request(
      path, [this, path, reply = std::move(reply)](const Bytes& file, const std::string& failure) {
        if (!failure.empty()) return reply(refusal(500, failure));
        if (!file) return reply(page_response(page_, path));
        reply({200, media_type(path), file});
      });
}

}  // namespace fovea
