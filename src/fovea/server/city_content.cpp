#include "fovea/server/city_content.h"

#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/exporting/city/city_description.h"
#include "fovea/server/city_tile_source.h"
#include "fovea/server/job_queue.h"

namespace fovea {
namespace {

constexpr int kThreads = 2;  // that read maps

class CityContent : public SiteContent {
 public:
  CityContent(City city, const ExposureChoice& exposure)
      : city_(std::move(city)), tiles_(city_, exposure, jobs_), jobs_(kThreads) {
    MapDescription description = describe_city(city_);
    description.tileset = "tiles/tileset.json";
    description.status = true;
    map_json_ = shared_bytes(to_json(description));
  }

  void request(const std::string& path, Receiver receiver) override {
    if (path == "map.json") return receiver(map_json_, "");
    if (path == "status.json") return receiver(shared_bytes(status_json()), "");
    if (path == "frames.json") {
      return jobs_.push([this, receiver = std::move(receiver)] { send_frames(receiver); });
    }
    if (!path.starts_with(kTilesFolder)) return receiver(nullptr, "");
    tiles_.request(path.substr(kTilesFolder.size()), std::move(receiver));
  }

 private:
  std::string status_json() const {
    nlohmann::json json = {{"state", "ready"}, {"read", 1}};
    const std::string failure = tiles_.failure();
    if (!failure.empty()) json["failure"] = failure;
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }

  void send_frames(const Receiver& receiver) {
    Bytes json;
    std::string failure;
    try {
      json = frames();
    } catch (const std::exception& error) {
      failure = error.what();
    }
    receiver(json, failure);
  }

  /// Reads the tiles once.
  Bytes frames() {
    const std::lock_guard lock(reading_frames_);
    if (!frames_json_) frames_json_ = shared_bytes(city_frames_text(city_));
    return frames_json_;
  }

  City city_;
  Bytes map_json_;
  std::mutex reading_frames_;
  Bytes frames_json_;
  CityTileSource tiles_;
  JobQueue jobs_;  // last: its jobs use all of the above
};

}  // namespace

std::unique_ptr<SiteContent> make_city_content(City city, const ExposureChoice& exposure) {
  return std::make_unique<CityContent>(std::move(city), exposure);
}

}  // namespace fovea
