#include "fovea/drive/live/live_imu.h"

#include "fovea/drive/live/recorded_rows.h"
#include "fovea/drive/navigation/imu_table.h"

namespace fovea {

std::optional<ImuData> LiveImu::begin(TimeNs until, Messages& messages) {
  is_used_ = is_used_ && !records_.empty();
  if (!is_used_) return std::nullopt;
  CsvRows rows = inertia_rows();
  const TimeNs end = records_.end_of(until);
  for (const RecordedInertia& record : records_.records()) {
    if (record.time <= end) add_inertia(rows, record);
  }
  ImuTable table = convert_imu(std::move(rows), name_ / "imu.csv", *description_.imu);
  messages.append(table);
  is_used_ = table.imu.has_value();
  force_scale_ = table.force_scale;
  last_ = end;
  return std::move(table.imu);
}

std::vector<ImuSample> LiveImu::take(TimeNs until) {
  std::vector<ImuSample> samples;
  if (!is_used_) return samples;
  const TimeNs end = records_.end_of(until);
  for (const RecordedInertia& record : records_.records()) {
    if (record.time > end) break;
    if (last_ && record.time <= *last_) continue;
    last_ = record.time;
    ImuSample sample =
        imu_sample(record.time, record.angular_velocity, record.acceleration, *description_.imu);
    if (why_unusable(sample) != nullptr) continue;
    sample.force *= force_scale_;
    samples.push_back(sample);
  }
  return samples;
}

std::vector<WheelSpeed> LiveWheels::begin(TimeNs until) {
  std::vector<WheelSpeed> speeds = take(until);
  is_used_ = !speeds.empty();
  return speeds;
}

std::vector<WheelSpeed> LiveWheels::take(TimeNs until) {
  std::vector<WheelSpeed> speeds;
  if (!is_used_) return speeds;
  const TimeNs end = records_.end_of(until);
  for (const WheelSpeed& wheel : records_.records()) {
    if (wheel.time > end) break;
    if (last_ && wheel.time <= *last_) continue;
    last_ = wheel.time;
    if (is_wheel_speed(wheel.speed)) speeds.push_back(wheel);
  }
  if (last_) records_.drop_before(*last_);
  return speeds;
}

}  // namespace fovea
