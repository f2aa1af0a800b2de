#include "fovea/drive/live/sensor_clocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "fovea/core/median.h"

namespace fovea {
namespace {

constexpr TimeNs kJump = kNsPerSecond / 2;
constexpr TimeNs kLatest = TimeNs(1) << 62;  // year 2116
// A sensor has jumped alone if it deviates from the LiDAR in kMessages and for kDeviates.
constexpr int kMessages = 5;
constexpr TimeNs kDeviates = kNsPerSecond;
constexpr TimeNs kLongestLoss = 10 * kNsPerSecond;
constexpr std::size_t kOffsets = 16, kMostShifts = 1000, kMostWarnings = 100;
constexpr int kLidarMessages = 10;  // after which the LiDAR does not share a jump

}  // namespace

SensorClocks::SensorClocks(std::vector<std::string> names, bool has_arrivals)
    : sensors_(names.size()), has_arrivals_(has_arrivals) {
  for (std::size_t i = 0; i < names.size(); ++i) sensors_[i].name = std::move(names[i]);
}

std::optional<TimeNs> SensorClocks::time_of(std::size_t number, TimeNs stamp, TimeNs arrival) {
  Sensor& sensor = sensors_[number];
  if (stamp < 0 || stamp >= kLatest) return std::nullopt;
  const Moment now{stamp, arrival};
  if (!sensor.stamps.last()) {
    sensor.common_shift = sensors_.front().common_shift;
    return accept(sensor, now);
  }
  const TimeNs step = stamp - *sensor.stamps.last();
  if (step < -kJump) return go_back(sensor, now);
  sensor.back.reset();
  const bool is_ahead = has_arrivals_ && step - (arrival - sensor.last_arrival) > kJump;
  if (is_ahead) return go_ahead(sensor, now);
  sensor.ahead.reset();
  return accept(sensor, now);
}

TimeNs SensorClocks::elapsed(const Sensor& sensor, TimeNs arrival) const {
  const TimeNs wall = has_arrivals_ ? std::max<TimeNs>(arrival - sensor.last_arrival, 0) : 0;
  const std::optional<TimeNs> usual = sensor.stamps.usual_step();
  if (!usual) return std::max<TimeNs>(wall, 1);
  return *usual * std::max<TimeNs>(1, std::llround(double(wall) / double(*usual)));
}

std::optional<TimeNs> SensorClocks::deviation(const Sensor& sensor, const Moment& now) const {
  if (!lidar_offset_ || sensor.offsets.empty()) return std::nullopt;
  const TimeNs offset = shifted(sensor, now.stamp) - now.arrival - *lidar_offset_;
  return offset - median_of(std::vector<TimeNs>(sensor.offsets.begin(), sensor.offsets.end()));
}

std::optional<TimeNs> SensorClocks::accept(Sensor& sensor, const Moment& now) {
  const bool is_later = !sensor.stamps.last() || now.stamp > *sensor.stamps.last();
  if (has_arrivals_ && is_later) follow_lidar(sensor, now);
  if (is_later) {
    sensor.stamps.add(now.stamp);
    sensor.last_arrival = now.arrival;
  }
  const TimeNs time = shifted(sensor, now.stamp);
  if (is_lidar(sensor) && is_later) {
    lidar_offset_ = time - now.arrival;
    report_lone_jumps();
  }
  if (time < 0 || time >= kLatest) return std::nullopt;
  return time;
}

void SensorClocks::follow_lidar(Sensor& sensor, const Moment& now) {
  if (is_lidar(sensor) || !lidar_offset_) return;
  const TimeNs away = deviation(sensor, now).value_or(0);
  if (std::abs(away) <= kJump) {
    sensor.behind.reset();
    sensor.offsets.push_back(shifted(sensor, now.stamp) - now.arrival - *lidar_offset_);
    if (sensor.offsets.size() > kOffsets) sensor.offsets.pop_front();
    return;
  }
  // Data that come late are no jump: they show no step in the stamps of the LiDAR.
  if (std::abs(away + lidar_ahead_) > kJump) return;
  if (!sensor.behind) sensor.behind = Ahead{lidar_ahead_, now.arrival, 0};
  Ahead& behind = *sensor.behind;
  if (++behind.messages < kMessages || now.arrival - behind.since < kDeviates) return;
  if (!is_lidar_ahead_reported_) warn(sensors_.front().name, "ahead", behind.amount);
  is_lidar_ahead_reported_ = true;
  sensor.own_shift += behind.amount;
  sensor.behind.reset();
}

std::optional<TimeNs> SensorClocks::go_back(Sensor& sensor, const Moment& now) {
  if (!sensor.back || now.stamp <= sensor.back->stamp ||
      now.stamp - sensor.back->stamp > kStoppedAfter) {
    sensor.back = now;
    return std::nullopt;
  }
  const Moment first = *std::exchange(sensor.back, std::nullopt);
  switch_clock(sensor, *sensor.stamps.last() + elapsed(sensor, first.arrival) - first.stamp);
  sensor.stamps = {};
  return accept(sensor, now);
}

void SensorClocks::switch_clock(Sensor& sensor, TimeNs amount) {
  const std::size_t next = sensor.common_shift + 1;
  const TimeNs total = common_shifts_[sensor.common_shift].total + amount;
  const bool is_last = next == common_shifts_.size();
  if (is_last && next < kMostShifts) {
    common_shifts_.push_back({total, amount, sensor.name});
  } else if (is_last || std::abs(common_shifts_[next].total - total) > kJump) {
    sensor.own_shift += amount;
    warn(sensor.name, "back", amount);
    return;
  }
  sensor.common_shift = next;
  CommonShift& shift = common_shifts_[next];
  if (!is_lidar(sensor) || shift.is_reported) return;
  warn(sensor.name, "back", shift.amount);
  shift.is_reported = true;
}

void SensorClocks::report_lone_jumps() {
  for (std::size_t i = sensors_.front().common_shift + 1; i < common_shifts_.size(); ++i) {
    CommonShift& shift = common_shifts_[i];
    if (shift.is_reported || ++shift.lidar_messages < kLidarMessages) continue;
    warn(shift.first, "back", shift.amount);
    shift.is_reported = true;
  }
}

std::optional<TimeNs> SensorClocks::go_ahead(Sensor& sensor, const Moment& now) {
  const TimeNs amount = now.stamp - *sensor.stamps.last() - elapsed(sensor, now.arrival);
  if (is_lidar(sensor)) {
    // A single message with such a stamp is of no time. Messages that are lost show shorter steps.
    if (!sensor.ahead && amount > kLongestLoss) {
      sensor.ahead = Ahead{amount, now.arrival, 0};
      return std::nullopt;
    }
    lidar_ahead_ = std::exchange(sensor.ahead, {}).value_or(Ahead{amount, 0, 0}).amount;
    is_lidar_ahead_reported_ = false;
    return accept(sensor, now);
  }
  const std::optional<TimeNs> away = deviation(sensor, now);
  if (!away || std::abs(*away) <= kJump) {
    sensor.ahead.reset();
    return accept(sensor, now);
  }
  if (!sensor.ahead) sensor.ahead = Ahead{amount, now.arrival, 0};
  if (++sensor.ahead->messages < kMessages || now.arrival - sensor.ahead->since < kDeviates) {
    return std::nullopt;
  }
  sensor.own_shift -= sensor.ahead->amount;
  warn(sensor.name, "ahead", sensor.ahead->amount);
  sensor.ahead.reset();
  return accept(sensor, now);
}

void SensorClocks::warn(const std::string& sensor, const char* direction, TimeNs amount) {
  if (messages_.warnings.size() == kMostWarnings) return;
  messages_.warn(
      fmt::format("the clock of {} jumps {} by {:.1f} s", sensor, direction, seconds(amount)));
}

}  // namespace fovea
