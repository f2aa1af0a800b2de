#include "fovea/drive/live/live_motion.h"

#include <utility>

namespace fovea {
namespace {

/// Of skipped frames, that the next frame gets.
constexpr TimeNs kSkippedMotion = 10 * kNsPerSecond;

/// Drops what is older than the last measurement of a sensor by more than a time.
void keep_last(MotionData& motion, TimeNs kept) {
  const auto old = [&](const auto& samples) {
    std::size_t count = 0;
    while (count < samples.size() && samples[count].time < samples.back().time - kept) ++count;
    return std::ptrdiff_t(count);
  };
  const std::ptrdiff_t poses = old(motion.poses);
  motion.poses.erase(motion.poses.begin(), motion.poses.begin() + poses);
  motion.accuracy.erase(motion.accuracy.begin(), motion.accuracy.begin() + poses);
  motion.imu.erase(motion.imu.begin(), motion.imu.begin() + old(motion.imu));
  motion.wheels.erase(motion.wheels.begin(), motion.wheels.begin() + old(motion.wheels));
}

template <class Item>
void append(std::vector<Item>& to, const std::vector<Item>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

LiveMotion::LiveMotion(const DriveDescription& description, const DriveOptions& options,
                       const std::filesystem::path& name, double longest_step)
    : description_(description),
      longest_step_(from_seconds(longest_step)),
      navigation_(description, options.use_navigation, name),
      imu_(description, options.use_imu, name),
      wheels_(options.use_imu) {}

bool LiveMotion::reaches(TimeNs time) const {
  return wheels_.reaches(time, longest_step_) && imu_.reaches(time, longest_step_) &&
         navigation_.reaches(time, longest_step_, imu_.records());
}

void LiveMotion::pass(TimeNs time) {
  navigation_.pass(time);
  imu_.records().pass(time);
  wheels_.records().pass(time);
}

FirstMotion LiveMotion::begin(const LocalFrame& frame, TimeNs until) {
  FirstMotion first;
  GenericNavigation navigation = navigation_.begin(frame, until, imu_.records());
  first.append(navigation);
  first.origin = navigation.origin;
  first.navigation = std::move(navigation.T_local_lidar);
  first.accuracy = std::move(navigation.accuracy);
  first.imu = imu_.begin(until, first);
  std::vector<WheelSpeed> speeds = wheels_.begin(until);
  if (!speeds.empty()) {
    first.wheels =
        WheelData{description_.wheels.T_lidar_body, description_.wheels.sigma, std::move(speeds)};
  }
  return first;
}

MotionData LiveMotion::take(TimeNs stamp, TimeNs until) {
  MotionData data;
  navigation_.take(stamp, until, imu_.records(), data);
  data.imu = imu_.take(until);
  data.wheels = wheels_.take(until);
  imu_.records().drop_before(until - LiveNavigation::kWindow);
  MotionData all = std::exchange(skipped_, {});
  append(all.poses, data.poses);
  append(all.accuracy, data.accuracy);
  append(all.imu, data.imu);
  append(all.wheels, data.wheels);
  if (data.begins) all.begins = data.begins;
  return all;
}

void LiveMotion::give_back(MotionData skipped) {
  skipped_ = std::move(skipped);
  keep_last(skipped_, kSkippedMotion);
}

}  // namespace fovea
