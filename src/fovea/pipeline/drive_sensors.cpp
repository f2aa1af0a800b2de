#include "fovea/pipeline/drive_sensors.h"

#include <utility>
#include <variant>
#include <vector>

#include "fovea/mapping/sensor_profile_estimate.h"

namespace fovea {

SensorProfile lidar_profile(const FrameSource& source) {
  constexpr std::size_t kScans = 3;
  const DriveInfo& drive = source.info();
  std::vector<PointCloud> scans;
  for (int index = drive.begin; index < drive.end && scans.size() < kScans; ++index) {
    FrameResult result = source.load(index);
    if (auto* frame = std::get_if<Frame>(&result)) scans.push_back(std::move(frame->scan));
  }
  return estimate_sensor_profile(scans, {});
}

}  // namespace fovea
