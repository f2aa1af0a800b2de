#include "fovea/drive/data_sets/data_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace fovea {

void add_scan(const std::filesystem::path& file, TimeNs stamp, const LidarScan& scan,
              const std::vector<DriveImage>& images,
              const std::optional<RigidMotion>& T_world_lidar, AdapterWriter& writer) {
  try {
    writer.add({stamp, scan.points}, images, T_world_lidar);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what(), file.string(), "restore the data set from its archives");
  }
}

std::string choose_scene(std::vector<std::string> names, const DataSetOptions& options,
                         const std::function<bool(const std::string& name)>& is_named) {
  std::vector<std::string> found;
  std::copy_if(names.begin(), names.end(), std::back_inserter(found),
               [&](const std::string& name) { return options.scene.empty() || is_named(name); });
  if (found.size() == 1) return found.front();
  std::sort(names.begin(), names.end());
  std::string problem = fmt::format("the data set has {} scenes", names.size());
  if (!options.scene.empty() && found.empty()) problem = "no scene has this name";
  if (!options.scene.empty() && found.size() > 1) problem = "several scenes have this name";
  throw ConfigError(problem, "--scene " + options.scene,
                    fmt::format("choose one of {}", fmt::join(names, ", ")));
}

}  // namespace fovea
