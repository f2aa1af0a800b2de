#include <nlohmann/json.hpp>

#include "fovea/exporting/viewer/map_description.h"
#include "fovea/server/map_site.h"
#include "fovea/server/site_content.h"
#include "fovea/server/tile_source.h"

namespace fovea {
namespace {

/// A map file.
class OneMap : public SiteContent {
 public:
  OneMap(const std::filesystem::path& map, const FrameImages* images,
         const ExposureChoice& exposure)
      : tiles_(map, exposure) {
    const MapReader reader(map);
    MapDescription description = describe_map(reader);
    description.tileset = "tiles/tileset.json";
    description.status = true;
    if (images != nullptr) {
      description.images = true;
      description.cameras = images->info().calibration.cameras;
      description.sensor_period = images->info().sweep.period;
    }
    map_json_ = shared_bytes(to_json(description));
    frames_json_ = shared_bytes(frames_json(reader.frames()).dump());
  }

  void request(const std::string& path, Receiver receiver) override {
    if (path == "map.json") return receiver(map_json_, "");
    if (path == "frames.json") return receiver(frames_json_, "");
    if (path == "status.json") return receiver(shared_bytes(status_json()), "");
    if (!path.starts_with(kTilesFolder)) return receiver(nullptr, "");
    tiles_.request(path.substr(kTilesFolder.size()), std::move(receiver));
  }

 private:
  std::string status_json() const {
    nlohmann::json json = {{"state", tiles_.read() < 1 ? "reading" : "ready"},
                           {"read", tiles_.read()}};
    const std::string failure = tiles_.failure();
    if (!failure.empty()) json["failure"] = failure;
    return json.dump();
  }

  Bytes map_json_, frames_json_;
  TileSource tiles_;
};

}  // namespace

std::unique_ptr<SiteContent> make_map_content(const std::filesystem::path& map,
                                              const FrameImages* images,
                                              const ExposureChoice& exposure) {
  return std::make_unique<OneMap>(map, images, exposure);
}

}  // namespace fovea
