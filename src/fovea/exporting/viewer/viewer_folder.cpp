#include "fovea/exporting/viewer/viewer_folder.h"

#include <nlohmann/json.hpp>

#include "fovea/exporting/viewer/map_description.h"

namespace fovea {

std::map<std::string, std::string> viewer_files(const MapReader& map,
                                                std::span<const PageFile> page, bool mesh) {
  std::map<std::string, std::string> files;
  for (const PageFile& file : page) files.emplace(file.name, file.bytes);
  MapDescription description = describe_map(map);
  description.tileset = "tileset.json";
  description.mesh = mesh;
  files["map.json"] = to_json(description);
  files["frames.json"] = frames_json(map.frames()).dump();
  return files;
}

}  // namespace fovea
