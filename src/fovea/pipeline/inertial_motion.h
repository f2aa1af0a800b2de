// Motion by an IMU, corrected by wheels, navigation and registered scans.
#pragma once

#include <optional>

#include "fovea/mapping/inertial_filter.h"
#include "fovea/pipeline/imu_agreement.h"
#include "fovea/pipeline/motion_guess.h"

namespace fovea {

/// How well scans confirm a pose.
enum class PoseEvidence {
  kFirm,
  kWeak,  ///< some direction of the motion is not determined
  kNone,  ///< the pose is a guess
};

class InertialMotion {
 public:
  /// Where the filter begins if it has not begun yet.
  struct Beginning {
    TimeNs time = 0;
    InertialStart start;
  };

  /// @param wheels  or null; both must outlive this
  InertialMotion(const ImuData& imu, const WheelData* wheels) : filter_(imu), wheels_(wheels) {}

  /// Pose, motion and deviations at a frame. Empty where the IMU has not measured, or is
  /// contradicted. Without deviations until it is proven.
  /// @param by_nav  corrects the prediction, unless it contradicts it or has no deviations
  std::optional<MotionGuess> predict(TimeNs stamp, const SweepSpan& sweep,
                                     const Beginning& beginning,
                                     const std::optional<MotionGuess>& by_nav) const;

  /// Enters the final pose of a frame.
  void update(TimeNs stamp, const RigidMotion& T_odom_lidar, PoseEvidence evidence,
              const Beginning& beginning, const std::optional<MotionGuess>& by_nav);

  /// Compares the motions of a frame that is not yet entered, relative to the last one.
  /// @param by_velocity  T_odom_lidar at constant velocity
  void compare(TimeNs stamp, const RigidMotion& T_odom_last, const RigidMotion& T_odom_lidar,
               const RigidMotion& by_velocity);
  /// Forgets the motion; the agreement stays.
  void restart() { filter_.restart(); }
  const ImuAgreement& agreement() const { return agreement_; }

 private:
  /// Empty where the IMU has not measured.
  std::optional<InertialFilter> begun(TimeNs stamp, const Beginning& beginning) const;
  InertialPrediction fused(const InertialFilter& filter, TimeNs stamp,
                           const std::optional<MotionGuess>& by_nav) const;
  std::optional<double> wheel_speed(TimeNs stamp) const;

  InertialFilter filter_;
  const WheelData* wheels_;
  ImuAgreement agreement_;
};

}  // namespace fovea
