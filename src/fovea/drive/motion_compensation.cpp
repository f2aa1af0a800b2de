#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "fovea/core/parallel.h"
#include "fovea/core/quick_angle.h"
#include "fovea/deskew.h"

namespace fovea {
namespace {

/// A block of points or directions of a sweep and their times: one array for each value, so that
/// loops vectorize.
struct SweepBlock {
  static constexpr std::size_t kSize = 256;
  using Row = std::array<double, kSize>;
  alignas(64) Row x{}, y{}, z{}, dt{}, sine{},
      versine{};  // m, s; sine and versine (1 - cosine) of the angle turned in dt

  void take(std::span<const Eigen::Vector3f> from) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      x[i] = double(from[i].x());
      y[i] = double(from[i].y());
      z[i] = double(from[i].z());
    }
  }
  void give(std::span<Eigen::Vector3f> to) const {
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = Eigen::Vector3d(x[i], y[i], z[i]).cast<float>();
  }
};

/// Motion over a time dt from the stamp: exp_se3(velocity * dt), after half the acceleration times
/// dt^2. The axis of rotation is constant, so a point needs one sine and one cosine. The
/// acceleration adds a few milliradians at most: its first-order rotation suffices.
class SweptMotion {
 public:
  explicit SweptMotion(const SweepMotion& motion)
      : rate_(motion.velocity.head<3>().norm()),
        turning_(motion.acceleration.head<3>() / 2),
        speeding_(motion.acceleration.tail<3>() / 2) {
    const Eigen::Vector3d v = motion.velocity.tail<3>();
    if (rate_ < kNegligibleRate) {
      rate_ = 0;
      along_ = v;
      return;
    }
    axis_ = motion.velocity.head<3>() / rate_;
    along_ = axis_.dot(v) * axis_;
    across_ = (v - along_) / rate_;
    turned_ = axis_.cross(v) / rate_;
  }

  /// Sines and versines for the times of a block. Angles within a sweep are small: their series has
  /// an error below 1e-14 and vectorizes.
  void turn(SweepBlock& block) const {
    constexpr double kSmall = 0.25;
    double largest = 0;
    for (std::size_t i = 0; i < SweepBlock::kSize; ++i) {
      const double a = rate_ * block.dt[i], b = a * a;
      block.sine[i] = a * (1 - b * (1. / 6 - b * (1. / 120 - b * (1. / 5040 - b / 362880))));
      block.versine[i] =
          b * (1. / 2 - b * (1. / 24 - b * (1. / 720 - b * (1. / 40320 - b / 3628800))));
      largest = std::max(largest, std::abs(a));
    }
    if (largest <= kSmall) return;
    for (std::size_t i = 0; i < SweepBlock::kSize; ++i) {
      block.sine[i] = std::sin(rate_ * block.dt[i]);
      block.versine[i] = 1 - std::cos(rate_ * block.dt[i]);
    }
  }

  /// The same rotation without a translation: for directions.
  SweptMotion rotation() const {
    SweptMotion rotation = *this;
    for (auto* translation :
         {&rotation.speeding_, &rotation.along_, &rotation.across_, &rotation.turned_}) {
      translation->setZero();
    }
    return rotation;
  }

  /// Moves a block by the motion over its times (Rodrigues' formula).
  void move(SweepBlock& block) const {
    // Local copies cannot alias the arrays, so the loop vectorizes.
    const Eigen::Vector3d axis = axis_, turning = turning_, along = along_, across = across_,
                          turned = turned_, speeding = speeding_;
    for (std::size_t i = 0; i < SweepBlock::kSize; ++i) {
      const double dt = block.dt[i], s = block.sine[i], v = block.versine[i], dt2 = dt * dt;
      const double x = block.x[i], y = block.y[i], z = block.z[i];
      const double qx = x + dt2 * (turning.y() * z - turning.z() * y) + dt2 * speeding.x();
      const double qy = y + dt2 * (turning.z() * x - turning.x() * z) + dt2 * speeding.y();
      const double qz = z + dt2 * (turning.x() * y - turning.y() * x) + dt2 * speeding.z();
      const double on_axis = axis.x() * qx + axis.y() * qy + axis.z() * qz;
      block.x[i] = qx + s * (axis.y() * qz - axis.z() * qy) + v * (on_axis * axis.x() - qx) +
                   (dt * along.x() + s * across.x() + v * turned.x());
      block.y[i] = qy + s * (axis.z() * qx - axis.x() * qz) + v * (on_axis * axis.y() - qy) +
                   (dt * along.y() + s * across.y() + v * turned.y());
      block.z[i] = qz + s * (axis.x() * qy - axis.y() * qx) + v * (on_axis * axis.z() - qz) +
                   (dt * along.z() + s * across.z() + v * turned.z());
    }
  }

 private:
  static constexpr double kNegligibleRate = 1e-9;  // rad/s: below a micrometer at 1 km in a second

  double rate_;
  Eigen::Vector3d turning_, speeding_;  // half the acceleration
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d along_ = Eigen::Vector3d::Zero();   // part of the velocity along the axis
  Eigen::Vector3d across_ = Eigen::Vector3d::Zero();  // part across it, over the rate
  Eigen::Vector3d turned_ = Eigen::Vector3d::Zero();  // axis x velocity, over the rate
};

/// The time of a point from the scan's stamp (s), by its azimuth.
class AzimuthTime {
 public:
  explicit AzimuthTime(const SweepTiming& sweep)
      : time_per_radian_((sweep.direction == SweepDirection::kClockwise ? -1 : 1) * sweep.period /
                         kTurn),
        middle_time_(sweep.middle_time()),
        middle_azimuth_(std::remainder(sweep.start_azimuth + kTurn / 2, kTurn)) {}

  double operator()(double azimuth) const {
    double from_middle = azimuth - middle_azimuth_;
    from_middle -= from_middle > kHalfTurn ? kTurn : 0;
    from_middle += from_middle < -kHalfTurn ? kTurn : 0;
    return time_per_radian_ * from_middle + middle_time_;
  }

 private:
  static constexpr double kTurn = 2 * std::numbers::pi;
  /// The margin keeps pi, rounded to a float, on its side of the turn.
  static constexpr double kHalfTurn = std::numbers::pi + 1e-6;

  double time_per_radian_, middle_time_, middle_azimuth_;
};

/// Finer than the steps of a path, so that matrices between two places are nearly rotations: at
/// 500 degrees a second they shorten a distance by a part in 10^5.
constexpr double kFineStep = 0.00125;  // s

/// A path as matrices at fine steps, and between them by linear interpolation.
class FinePath {
 public:
  explicit FinePath(const SweepPath& path) : begin_(path.begin) {
    const double length = path.step * double(path.placements.size() - 1);
    const auto steps = static_cast<std::size_t>(std::ceil(length / kFineStep));
    for (std::size_t i = 0; i <= steps; ++i) {
      places_.emplace_back(path.at(begin_ + kFineStep * double(i)).matrix().topRows<3>());
    }
  }

  Eigen::Matrix<double, 3, 4> at(double dt) const {
    const double place = (dt - begin_) / kFineStep;
    const double whole = std::clamp(std::floor(place), 0.0, double(places_.size() - 2));
    const auto& from = places_[static_cast<std::size_t>(whole)];
    return from + (place - whole) * (places_[static_cast<std::size_t>(whole) + 1] - from);
  }

 private:
  double begin_;
  std::vector<Eigen::Matrix<double, 3, 4>> places_;
};

void compensate_along(PointCloud& scan_lidar, const SweepPath& path, const SweepTiming& sweep) {
  constexpr std::size_t kGrain = 8192;
  const FinePath fine(path);
  const AzimuthTime azimuth_time(sweep);
  parallel_for(scan_lidar.size(), kGrain, [&](std::size_t i) {
    Eigen::Vector3f& p = scan_lidar.position[i];
    const double dt = scan_lidar.time.empty() ? azimuth_time(double(quick_atan2(p.y(), p.x())))
                                              : double(scan_lidar.time[i]);
    const Eigen::Matrix<double, 3, 4> T = fine.at(dt);
    p = (T.leftCols<3>() * p.cast<double>() + T.col(3)).cast<float>();
    if (scan_lidar.normal.empty()) return;
    scan_lidar.normal[i] = (T.leftCols<3>() * scan_lidar.normal[i].cast<double>()).cast<float>();
  });
  scan_lidar.time.clear();
}

}  // namespace

void add_point_times(PointCloud& scan_sensor, const SweepTiming& sweep) {
  const AzimuthTime azimuth_time(sweep);
  scan_sensor.time.clear();
  scan_sensor.time.reserve(scan_sensor.size());
  for (const Eigen::Vector3f& p : scan_sensor.position) {
    scan_sensor.time.push_back(float(azimuth_time(double(quick_atan2(p.y(), p.x())))));
  }
}

void compensate_sweep(PointCloud& scan_lidar, const SweepMotion& motion, const SweepTiming& sweep) {
  if (!scan_lidar.origin.isZero()) {
    throw std::invalid_argument("a sweep's origin must be the LiDAR: azimuths are taken from it");
  }
  if (motion.path) return compensate_along(scan_lidar, *motion.path, sweep);
  constexpr std::size_t kGrain = 32 * SweepBlock::kSize;
  const SweptMotion swept(motion), swept_rotation = swept.rotation();
  const AzimuthTime azimuth_time(sweep);
  parallel_chunks(scan_lidar.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    SweepBlock block;
    for (; begin < end; begin += SweepBlock::kSize) {
      const std::size_t n = std::min(SweepBlock::kSize, end - begin);
      const auto of_block = [&](auto& column) { return std::span(column).subspan(begin, n); };
      block.take(of_block(scan_lidar.position));
      if (scan_lidar.time.empty()) {
        for (std::size_t i = 0; i < SweepBlock::kSize; ++i) {
          const auto x = static_cast<float>(block.x[i]), y = static_cast<float>(block.y[i]);
          block.dt[i] = azimuth_time(double(quick_atan2(y, x)));
        }
      } else {
        std::ranges::copy(of_block(scan_lidar.time), block.dt.begin());
      }
      swept.turn(block);
      swept.move(block);
      block.give(of_block(scan_lidar.position));
      if (scan_lidar.normal.empty()) continue;
      block.take(of_block(scan_lidar.normal));
      swept_rotation.move(block);
      block.give(of_block(scan_lidar.normal));
    }
  });
  scan_lidar.time.clear();
}

}  // namespace fovea
