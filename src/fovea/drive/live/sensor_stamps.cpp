#include "fovea/drive/live/sensor_stamps.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "fovea/core/median.h"

namespace fovea {
namespace {

constexpr std::size_t kFewest = 4, kKept = 32;  // steps
// As in recordings/missing_messages.cpp: the share of steps that a steady rate has near the median
// one, and how near.
constexpr std::size_t kFewestSteady = 10;
constexpr double kSteady = 0.7, kJitter = 0.2;

}  // namespace

void SensorStamps::add(TimeNs stamp) {
  if (last_) {
    const TimeNs step = stamp - *last_;
    const std::optional<TimeNs> usual = usual_step();
    if (usual && step <= kStoppedAfter && is_steady(*usual)) {
      missing_ += std::size_t(std::max(0.0, std::round(double(step) / double(*usual)) - 1));
    }
    steps_.push_back(step);
    if (steps_.size() > kKept) steps_.pop_front();
  }
  last_ = stamp;
  misses_ = 0;
}

std::optional<TimeNs> SensorStamps::usual_step() const {
  if (steps_.size() < kFewest) return std::nullopt;
  return median_of(std::vector<TimeNs>(steps_.begin(), steps_.end()));
}

bool SensorStamps::is_steady(TimeNs usual) const {
  if (steps_.size() < kFewestSteady) return false;
  const auto near = std::count_if(steps_.begin(), steps_.end(), [&](TimeNs step) {
    return std::abs(double(step - usual)) < kJitter * double(usual);
  });
  return double(near) >= kSteady * double(steps_.size());
}

}  // namespace fovea
