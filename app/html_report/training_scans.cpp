#include "app/html_report/training_scans.h"

#include <algorithm>

#include "app/html_report/markup.h"
#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/config.h"

namespace fovea::app {

std::vector<PlacedFrame> training_scans(const ScoredMap& map, const FrameSource& drive,
                                        const std::vector<PlacedFrame>& scored) {
  ProtocolOptions options;
  options.protocol = Protocol::kInSample;
  std::vector<PlacedFrame> frames;
  try {
    frames = select_frames(map, drive, options);
  } catch (const InputError&) {
    return {};  // nothing was mapped
  }
  if (map.statuses_known) return frames;
  std::erase_if(frames, [&](const PlacedFrame& frame) {
    return std::any_of(scored.begin(), scored.end(),
                       [&](const PlacedFrame& s) { return s.index == frame.index; });
  });
  return frames;
}

std::optional<TrainingFrame> load_frame(const FrameSource& drive, const PlacedFrame& placed) {
  const DriveInfo& info = drive.info();
  if (placed.index < info.begin || placed.index >= info.end) return std::nullopt;
  LoadedFrame loaded = drive.load(placed.index);
  if (std::holds_alternative<SkippedFrame>(loaded)) return std::nullopt;
  TrainingFrame result{std::move(std::get<Frame>(loaded)), {}};
  result.scan_lidar = compensated_scan(result.frame.scan, placed, info);
  return result;
}

MapSettings settings_of(const ScoredMap& map) {
  const auto config = map.meta.find(meta_key::kConfig);
  if (config == map.meta.end()) return load_preset("default");
  try {
    return stored_settings(config->second, "the map's configuration");
  } catch (const ConfigError&) {
    return load_preset("default");  // written by a newer version
  }
}

std::string excuse(const std::string& why) {
  return "<p class=\"note\">" + escaped(why) + "</p>\n";
}

}  // namespace fovea::app
