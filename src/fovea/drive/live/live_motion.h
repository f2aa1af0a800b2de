// Navigation, IMU and wheels of a live drive, from their arrival to the frames.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/drive/live/live_imu.h"
#include "fovea/drive/live/live_navigation.h"

namespace fovea {

/// What the drive has from its beginning.
struct FirstMotion : Messages {
  std::optional<Trajectory> navigation;
  std::vector<double> accuracy;
  std::optional<GeodeticPoint> origin;
  std::optional<ImuData> imu;
  std::optional<WheelData> wheels;
};

class LiveMotion {
 public:
  /// @param description   must outlive this
  /// @param name          of the drive, for messages
  /// @param longest_step  s, between the records of sensors that are waited for
  LiveMotion(const DriveDescription& description, const DriveOptions& options,
             const std::filesystem::path& name, double longest_step);

  // False for a record that is not later than the one before: it is dropped.
  bool add(const RecordedPose& pose) { return navigation_.add(pose); }
  bool add(const RecordedPosition& position) { return navigation_.add(position); }
  bool add(const RecordedInertia& inertia) { return imu_.records().add(inertia); }
  bool add(const WheelSpeed& speed) { return wheels_.records().add(speed); }

  bool has_navigation() const { return !navigation_.empty(); }
  bool has_inertia() const { return !imu_.records().empty(); }

  /// Whether every sensor that the drive uses, and that is fast enough to wait for, has sent a
  /// record at a time or later. A sensor that has stopped is not waited for.
  bool reaches(TimeNs time) const;

  /// A frame ends at this time, whether all have reached it or not.
  void pass(TimeNs time);

  /// Fixes the frame `local`, the units and the sensors. Converts the records up to the first one
  /// at `until` or later.
  /// @throws InputError  as convert_navigation()
  FirstMotion begin(const LocalFrame& frame, TimeNs until);

  /// The results after those before, up to the first record at `until` or later.
  /// @param stamp  of the frame
  MotionData take(TimeNs stamp, TimeNs until);
  /// The motion of a frame that is skipped. The next one gets it.
  void give_back(MotionData skipped);

  LiveNavigation& navigation() { return navigation_; }
  const LiveNavigation& navigation() const { return navigation_; }

 private:
  const DriveDescription& description_;
  TimeNs longest_step_;
  LiveNavigation navigation_;
  LiveImu imu_;
  LiveWheels wheels_;
  MotionData skipped_;
};

}  // namespace fovea
