// Orientation of a gyroscope over time, by integration of its rates.
#pragma once

#include <vector>

#include "fovea/geometry/imu_data.h"

namespace fovea {

/// Integrates the rates once. The rotation over an interval then costs two binary searches.
class GyroscopeOrientation {
 public:
  /// Rates are linear in time between samples (trapezoidal rule).
  /// @param samples  in strictly increasing time; must outlive this object
  /// @param scale    multiplies all rates
  explicit GyroscopeOrientation(const std::vector<ImuSample>& samples, double scale = 1);

  /// Whether samples without a gap include this interval of stamps. A gap is longer than three
  /// median steps and longer than 25 ms.
  bool covers(TimeNs begin, TimeNs end) const;

  /// R_start_imu, where start is the frame of the IMU at the first sample. Constant before the
  /// first and after the last sample.
  Eigen::Quaterniond at(TimeNs stamp) const;

  /// Rotation vector of R_begin_end (rad), in the axes of the IMU at `begin`.
  Eigen::Vector3d turn(TimeNs begin, TimeNs end) const;

 private:
  /// The last sample at or before a stamp, which must not precede the first sample.
  std::size_t sample_before(TimeNs stamp) const;
  /// Rotation from sample i to a stamp before sample i + 1.
  Eigen::Quaterniond partial_step(std::size_t i, TimeNs stamp) const;

  const std::vector<ImuSample>* samples_;
  double scale_;
  std::vector<Eigen::Quaterniond> orientations_;  ///< at each sample
  std::vector<int> gaps_before_;                  ///< number of gaps before each sample
};

}  // namespace fovea
