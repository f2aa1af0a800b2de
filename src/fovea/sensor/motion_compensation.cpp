#include "fovea/sensor/motion_compensation.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "fovea/base/parallel.h"
#include "fovea/base/quick_angle.h"

namespace fovea {
namespace {

/// exp_se3(velocity * dt) for many dt: the axis does not change, only the angle along it does, so a
/// point costs one sine and one cosine.
class ConstantTwist {
 public:
  explicit ConstantTwist(const Twist& velocity)
      : rate_(velocity.head<3>().norm()), v_(velocity.tail<3>()) {
    if (rate_ < kNegligibleRate) {
      rate_ = 0;
      return;
    }
    axis_ = velocity.head<3>() / rate_;
    v_along_ = axis_.dot(v_) * axis_;
    v_across_ = (v_ - v_along_) / rate_;
    v_turned_ = axis_.cross(v_) / rate_;
  }

  /// Rodrigues; `v` is 1 less the cosine.
  Eigen::Vector3d rotate(const Eigen::Vector3d& p, double s, double v) const {
    return p + s * axis_.cross(p) + v * (axis_.dot(p) * axis_ - p);
  }

  /// Point `p` (and its direction `normal`, where there is one) moved by the motion over `dt`.
  Eigen::Vector3d move(const Eigen::Vector3d& p, double dt, Eigen::Vector3f* normal) const {
    if (rate_ == 0) return p + dt * v_;
    const auto [s, v] = sine_and_versine(rate_ * dt);
    if (normal != nullptr) *normal = rotate(normal->cast<double>(), s, v).cast<float>();
    return rotate(p, s, v) + dt * v_along_ + s * v_across_ + v * v_turned_;
  }

 private:
  /// sin(a) and 1 - cos(a). Of the small angles within a sweep by their series, to 1e-14: a
  /// library's sine for each of 100,000 points takes as long as all else.
  static std::pair<double, double> sine_and_versine(double a) {
    constexpr double kSmall = 0.25;
    if (!(std::abs(a) <= kSmall)) return {std::sin(a), 1 - std::cos(a)};
    const double b = a * a;
    return {a * (1 - b * (1. / 6 - b * (1. / 120 - b * (1. / 5040 - b * (1. / 362880))))),
            b * (1. / 2 - b * (1. / 24 - b * (1. / 720 - b * (1. / 40320 - b * (1. / 3628800)))))};
  }

  static constexpr double kNegligibleRate = 1e-9;  // rad/s: below a micrometre at 1 km in a second

  double rate_;
  Eigen::Vector3d v_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_along_ = Eigen::Vector3d::Zero();   // part of v_ along the axis
  Eigen::Vector3d v_across_ = Eigen::Vector3d::Zero();  // part across it, over the rate
  Eigen::Vector3d v_turned_ = Eigen::Vector3d::Zero();  // axis x v_, over the rate
};

}  // namespace

void compensate_sweep(PointCloud& scan_lidar, const SweepMotion& motion, double period) {
  if (!scan_lidar.origin.isZero()) {
    throw std::invalid_argument("a sweep's origin must be the LiDAR: azimuths are taken from it");
  }
  constexpr std::size_t kGrain = 8192;
  const ConstantTwist steady(motion.velocity);
  const Eigen::Vector3d turning = motion.acceleration.head<3>() / 2;
  const Eigen::Vector3d speeding = motion.acceleration.tail<3>() / 2;
  const double time_per_radian = -period / (2 * std::numbers::pi);  // clockwise
  const bool timed = !scan_lidar.time.empty();
  parallel_for(scan_lidar.size(), kGrain, [&](std::size_t i) {
    Eigen::Vector3f& p = scan_lidar.position[i];
    const double dt =
        timed ? double(scan_lidar.time[i]) : time_per_radian * double(quick_atan2(p.y(), p.x()));
    Eigen::Vector3f* normal = scan_lidar.normal.empty() ? nullptr : &scan_lidar.normal[i];
    // What the acceleration adds is a few milliradians at most: no sine is needed for that.
    const Eigen::Vector3d q = p.cast<double>();
    const Eigen::Vector3d changed = q + dt * dt * (turning.cross(q) + speeding);
    if (normal != nullptr) *normal += (dt * dt * turning).cast<float>().cross(*normal);
    p = steady.move(changed, dt, normal).cast<float>();
  });
  scan_lidar.time.clear();
}

}  // namespace fovea
