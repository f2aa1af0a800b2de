#include "fovea/pipeline/live_clocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fovea {
namespace {

/// An offset is corrected if it exceeds both limits: s, and in standard deviations.
constexpr double kLeastOffset = 2e-3, kDeviations = 3;

/// Slope of a line through offsets, s per s, where there are enough.
std::optional<double> drift_of(const std::vector<std::pair<double, double>>& offsets) {
  constexpr std::size_t kEnough = 3;
  if (offsets.size() < kEnough) return std::nullopt;
  double time = 0, offset = 0;
  for (const auto& [t, o] : offsets) time += t, offset += o;
  time /= double(offsets.size());
  offset /= double(offsets.size());
  double products = 0, squares = 0;
  for (const auto& [t, o] : offsets) {
    products += (t - time) * (o - offset);
    squares += (t - time) * (t - time);
  }
  return products / squares;
}

}  // namespace

LiveClocks::LiveClocks(const DriveInfo& drive, bool compensate)
    : drive_(drive), compensate_(compensate) {
  check_.emplace(drive, compensate, /*is_live=*/true);
  for (const Camera& camera : drive.calibration.cameras) {
    cameras_.push_back({fmt::format("camera {}", camera.index), 0, {}});
  }
  if (!drive.imu || drive.imu->samples.empty()) return;
  samples_ = drive.imu->samples;
  last_sample_ = samples_.back().time;
}

void LiveClocks::add(const Frame& frame, const FrameRecord& record,
                     const std::optional<FrameMotion>& motion) {
  if (!window_begin_) window_begin_ = frame.index;
  if (frame.index < *window_begin_) return;
  if (motion && is_due(frame.index)) check_->add_edges(frame, *motion);
  imu_check_.add(record);
  samples_.insert(samples_.end(), frame.motion.imu.begin(), frame.motion.imu.end());
  if (frame.index - *window_begin_ + 1 >= kWindow) end_window(frame.index, frame.stamp);
}

void LiveClocks::end_window(int frame, TimeNs time) {
  const DriveCalibration found = check_->estimate();
  if (!first_) first_ = found;
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    const CalibrationEstimate& estimate = found.cameras[k].estimate;
    if (!estimate.delay_observable()) continue;
    measure(cameras_[k], time, estimate.correction.delay, estimate.sigma.delay);
  }
  if (drive_.imu && !samples_.empty()) {
    ImuData imu = *drive_.imu;
    imu.samples = std::exchange(samples_, {});
    const ImuHandEye estimate = imu_check_.estimate(imu);
    if (estimate.delay_observable) measure(imu_, time, estimate.delay, estimate.delay_sigma);
  }
  Correction correction{frame + kLag, {}, imu_.corrected};
  for (const Sensor& camera : cameras_) correction.cameras.push_back(camera.corrected);
  const std::lock_guard lock(guard_);
  corrections_.push_back(std::move(correction));
  window_begin_ = frame + kLag;  // with one correction for all of its frames
  check_.emplace(drive_, compensate_, /*is_live=*/true, *window_begin_);
  imu_check_ = {};
}

void LiveClocks::measure(Sensor& sensor, TimeNs time, double delay, double sigma) {
  sensor.measured.push_back({time, sensor.corrected + delay, sigma});
  const bool is_off = std::abs(delay) > std::max(kLeastOffset, kDeviations * sigma);
  if (is_off) sensor.corrected += delay;
}

void LiveClocks::correct(Frame& frame) {
  const Correction* holds = nullptr;
  const std::lock_guard lock(guard_);
  for (const Correction& correction : corrections_) {
    if (correction.from_frame <= frame.index) holds = &correction;
  }
  if (holds == nullptr) return;
  frame.image_offsets.resize(std::max(frame.image_offsets.size(), holds->cameras.size()));
  for (std::size_t k = 0; k < holds->cameras.size(); ++k) {
    frame.image_offsets[k] += holds->cameras[k];
  }
  // Where a correction begins, some samples may come before those that are known already.
  std::vector<ImuSample>& samples = frame.motion.imu;
  for (ImuSample& sample : samples) sample.time += from_seconds(holds->imu);
  std::erase_if(samples, [&](const ImuSample& sample) { return sample.time <= last_sample_; });
  if (!samples.empty()) last_sample_ = samples.back().time;
}

void LiveClocks::report(const Sensor& sensor, Messages& messages) const {
  if (sensor.corrected != 0) {
    messages.warn(fmt::format("the clock of {} is {:.1f} ms off that of the LiDAR: corrected",
                              sensor.name, 1e3 * sensor.corrected));
  }
  std::vector<std::pair<double, double>> offsets;
  offsets.reserve(sensor.measured.size());
  for (const Measurement& measured : sensor.measured) {
    offsets.emplace_back(seconds(measured.time - sensor.measured.front().time), measured.offset);
  }
  if (const auto drift = drift_of(offsets)) {
    messages.notes.push_back(fmt::format("the clock of {} drifts by {:.1f} ppm against the LiDAR's",
                                         sensor.name, 1e6 * *drift));
  }
}

Messages LiveClocks::messages() const {
  Messages messages;
  for (const Sensor& camera : cameras_) report(camera, messages);
  report(imu_, messages);
  return messages;
}

}  // namespace fovea
