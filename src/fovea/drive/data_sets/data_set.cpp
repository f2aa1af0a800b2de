#include "fovea/drive/data_sets/data_set.h"

#include <stdexcept>

namespace fovea {

void add_scan(const std::filesystem::path& file, TimeNs stamp, const LidarScan& scan,
              const std::vector<DriveImage>& images,
              const std::optional<RigidMotion>& T_world_lidar, DriveWriter& writer) {
  try {
    writer.add({stamp, scan.points}, images, T_world_lidar);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what(), file.string(), "restore the data set from its archives");
  }
}

}  // namespace fovea
