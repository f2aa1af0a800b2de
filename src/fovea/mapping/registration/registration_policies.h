// Policies that registration adds to the textbook loop of iterative closest point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "fovea/mapping/registration/pair_equations.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// A step is small if its rotation and its translation are both below these limits.
struct StepLimit {
  double rotation = 1e-4;     ///< rad
  double translation = 1e-3;  ///< m
  bool contains(const Twist& step, double scale = 1) const {
    return step.head<3>().norm() < scale * rotation && step.tail<3>().norm() < scale * translation;
  }
};

/// Starts with a wide robust kernel and halves its width each round. From a poor guess, correct
/// pairs are far apart, and a narrow kernel would reject them.
class NarrowingKernel {
 public:
  /// @param first_width, final_width  m; a final width of 0 switches the kernel off
  NarrowingKernel(bool enabled, double first_width, double final_width)
      : first_(enabled && final_width > 0 ? first_width : final_width), final_(final_width) {}

  double width(int round) const { return std::max(final_, std::ldexp(first_, -round)); }
  bool is_final(int round) const { return width(round) <= final_; }

 private:
  double first_, final_;
};

/// Registers a sample of the source points until the pose is nearly found. The early rounds need
/// only the direction of the motion, which a sample gives at a fraction of the time.
class CoarsePhase {
 public:
  CoarsePhase(bool enabled, std::size_t source_points)
      : is_active_(enabled && source_points > kPoints), source_points_(source_points) {}

  bool is_active() const { return is_active_; }
  /// Number of source points to register.
  std::size_t points() const { return is_active_ ? kPoints : source_points_; }

  /// Ends the phase if the last step was nearly small, or after many rounds: the sample may have
  /// no stable pose.
  /// @return whether it ended
  bool end_if_due(const Twist& step, int rounds, const StepLimit& limit) {
    if (!is_active_ || !(limit.contains(step, kNearlyFound) || rounds >= kMaxRounds)) return false;
    is_active_ = false;
    return true;
  }

 private:
  static constexpr std::size_t kPoints = 2000;
  static constexpr double kNearlyFound = 20;
  static constexpr int kMaxRounds = 30;
  bool is_active_;
  std::size_t source_points_;
};

/// Keeps a pair while its source point moves little. The nearest target point is then the same, or
/// another one on the same surface.
class PairCache {
 public:
  /// @param max_move      of a source point, m
  /// @param rms_distance  of the pairs in the last round, m
  PairCache(bool enabled, double max_move, double rms_distance)
      : max_move_(enabled ? static_cast<float>(std::min(max_move, kMaxShare * rms_distance)) : 0) {}

  /// @param p  position of the source point in the target's axes
  bool is_valid(const Pair& pair, const Eigen::Vector3f& p) const {
    return (p - pair.searched_at).squaredNorm() < max_move_ * max_move_;
  }

 private:
  static constexpr double kMaxShare = 0.1;
  float max_move_;
};

/// Lengthens steps that continue in one direction (Aitken's delta-squared process). From a poor
/// guess in a street, a narrow kernel leaves few correct pairs, and plain steps are very short:
/// steps that shrink by a ratio r sum up to 1 / (1 - r) times the first of them.
class AitkenAcceleration {
 public:
  AitkenAcceleration(bool enabled, const StepLimit& limit) : is_enabled_(enabled), limit_(limit) {}

  /// Factor by which to lengthen this step; 1 for a small step and after a change of direction.
  double factor(const Twist& step) {
    const Eigen::Vector3d now = step.tail<3>(), before = std::exchange(last_, now);
    const double dot = now.dot(before);
    // A reversal means that a lengthened step went too far. Smaller factors prevent a cycle.
    if (dot < 0) max_factor_ = std::max(1.0, max_factor_ * kReduction);
    const bool same_direction = dot > kMinCosine * now.norm() * before.norm();
    if (!is_enabled_ || !same_direction || limit_.contains(step, kMinStep)) return 1;
    const double ratio = now.norm() / before.norm();
    return ratio < 1 ? std::min(max_factor_, 1 / (1 - ratio)) : max_factor_;
  }

 private:
  static constexpr double kMinCosine = 0.9;
  static constexpr double kReduction = 0.75;
  static constexpr double kMinStep = 5;  // limits
  bool is_enabled_;
  StepLimit limit_;
  double max_factor_ = 4;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
};

}  // namespace fovea
