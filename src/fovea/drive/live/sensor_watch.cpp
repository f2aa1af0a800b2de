#include "fovea/drive/live/sensor_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fovea {
namespace {

constexpr std::size_t kMostWarnings = 100;
constexpr TimeNs kLongestStep = kNsPerSecond;  // longer ones are pauses

}  // namespace

SensorWatch::SensorWatch(std::vector<std::string> names) {
  sensors_.reserve(names.size());
  for (std::string& name : names) sensors_.push_back({std::move(name), State::kBefore, {}});
}

void SensorWatch::begin(const std::vector<bool>& is_used, const std::vector<bool>& is_wanted) {
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    sensors_[i].state = is_used[i]     ? State::kUsed
                        : is_wanted[i] ? State::kUnused
                                       : State::kReported;
  }
}

void SensorWatch::use(std::size_t sensor, TimeNs stamp) {
  Sensor& of = sensors_[sensor];
  if (of.state == State::kUsed) return;
  of.state = State::kUsed;
  messages_.notes.push_back(
      fmt::format("{} is used since {:.1f} s of the drive", of.name, time_of(stamp)));
}

void SensorWatch::add(std::size_t sensor, TimeNs stamp) {
  if (!newest_) newest_ = stamp;
  if (sensor == 0 && !first_) first_ = stamp;
  clock_ += std::clamp<TimeNs>(stamp - *newest_, 0, kLongestStep);
  newest_ = std::max(*newest_, stamp);
  Sensor& of = sensors_[sensor];
  if (of.state == State::kUnused) {
    warn(fmt::format("{} sends data after the beginning: they are not used", of.name));
    of.state = State::kReported;
  } else if (of.state == State::kStopped) {
    warn(fmt::format("{} sends data again, after {:.1f} s", of.name, seconds(stamp - *of.last)));
    of.state = State::kUsed;
  }
  if (of.last) of.step = stamp - *of.last;
  of.last = stamp;
  of.last_clock = clock_;
  check();
}

void SensorWatch::check() {
  for (Sensor& sensor : sensors_) {
    if (sensor.state != State::kUsed || !sensor.last) continue;
    // A slow sensor may send nothing for longer.
    if (clock_ - sensor.last_clock <= std::max(kStoppedAfter, 3 * sensor.step)) continue;
    warn(fmt::format("{} has sent no data since {:.1f} s of the drive", sensor.name,
                     time_of(*sensor.last)));
    sensor.state = State::kStopped;
    sensor.step = 0;
  }
}

void SensorWatch::warn(std::string text) {
  if (messages_.warnings.size() == kMostWarnings) return;
  if (messages_.warnings.size() + 1 == kMostWarnings) text = "further warnings are left out";
  messages_.warn(std::move(text));
}

}  // namespace fovea
