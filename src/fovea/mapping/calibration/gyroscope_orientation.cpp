#include "fovea/mapping/calibration/gyroscope_orientation.h"

#include <algorithm>

#include "fovea/geometry/imu_gap.h"
#include "fovea/geometry/rotation_vector.h"

namespace fovea {

constexpr int kGapSteps = 3;  // a gap distorts a turn more than a path

GyroscopeOrientation::GyroscopeOrientation(const std::vector<ImuSample>& samples, double scale)
    : samples_(&samples), scale_(scale) {
  const TimeNs longest = imu_gap_limit(samples, kGapSteps);
  orientations_.reserve(samples.size());
  gaps_before_.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i == 0) {
      orientations_.push_back(Eigen::Quaterniond::Identity());
      gaps_before_.push_back(0);
      continue;
    }
    const TimeNs step = samples[i].time - samples[i - 1].time;
    orientations_.push_back(
        (orientations_.back() * partial_step(i - 1, samples[i].time)).normalized());
    gaps_before_.push_back(gaps_before_.back() + (step > longest ? 1 : 0));
  }
}

std::size_t GyroscopeOrientation::sample_before(TimeNs stamp) const {
  const auto later = [](TimeNs time, const ImuSample& sample) { return time < sample.time; };
  const auto after = std::upper_bound(samples_->begin(), samples_->end(), stamp, later);
  return static_cast<std::size_t>(after - samples_->begin()) - 1;
}

Eigen::Quaterniond GyroscopeOrientation::partial_step(std::size_t i, TimeNs stamp) const {
  const ImuSample& from = (*samples_)[i];
  const ImuSample& to = (*samples_)[i + 1];
  const double share = seconds(stamp - from.time) / seconds(to.time - from.time);
  const Eigen::Vector3d mean_rate = from.rate + share / 2 * (to.rate - from.rate);
  return quaternion_of(scale_ * seconds(stamp - from.time) * mean_rate);
}

bool GyroscopeOrientation::covers(TimeNs begin, TimeNs end) const {
  if (samples_->empty() || begin < samples_->front().time || end > samples_->back().time) {
    return false;
  }
  const std::size_t before = sample_before(end);
  const std::size_t last = (*samples_)[before].time == end ? before : before + 1;
  return gaps_before_[last] == gaps_before_[sample_before(begin)];
}

Eigen::Quaterniond GyroscopeOrientation::at(TimeNs stamp) const {
  if (samples_->empty() || stamp <= samples_->front().time) return Eigen::Quaterniond::Identity();
  if (stamp >= samples_->back().time) return orientations_.back();
  const std::size_t i = sample_before(stamp);
  return orientations_[i] * partial_step(i, stamp);
}

Eigen::Vector3d GyroscopeOrientation::turn(TimeNs begin, TimeNs end) const {
  return rotation_vector(at(begin).conjugate() * at(end));
}

}  // namespace fovea
