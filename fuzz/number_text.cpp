// Numbers and sensor profiles as the map's text columns have them, and pose files.
#include "fovea/map/number_text.h"

#include "fovea/geometry/pose_file.h"
#include "fovea/map/sensor_json.h"
#include "fuzz_input.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static FileInMemory file;
  const std::string_view text = as_text(data, size);
  if (const auto numbers = numbers_from_text(text)) {
    require(numbers_from_text(to_text(*numbers)) == numbers, "numbers come back");
  }
  if (const auto pose = motion_from_text(text)) {
    require(pose->matrix().allFinite(), "a pose is finite");
    require(motion_from_text(format_pose(*pose))->matrix() == pose->matrix(), "a pose comes back");
  }
  if (const auto motion = sweep_motion_from_text(text)) {
    require(sweep_motion_from_text(to_text(*motion)) == motion, "a motion comes back");
  }
  if (const auto numbers = numbers_from_json(text)) {
    const std::string json = to_json(*numbers);
    const auto again = numbers_from_json(json);
    require(again && to_json(*again) == json, "a JSON object comes back");
  }
  if (const auto profile = sensor_profile_from_json(text)) {
    require(sensor_profile_from_json(to_json(*profile)) == profile, "a sensor profile comes back");
  }
  read_or_refuse([&] {
    for (const RigidMotion& pose : read_poses(file.hold(text))) {
      require(pose.matrix().allFinite(), "a pose of a file is finite");
    }
  });
  return 0;
}
