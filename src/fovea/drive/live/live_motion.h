// Poses, positions, IMU and wheels of a live drive, from their arrival to the frames.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>

#include "fovea/drive/drive_description.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/live/match_queue.h"
#include "fovea/drive/navigation/generic_navigation.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// Records of a sensor, in the order of their stamps: those that no frame has had, and a few
/// seconds before them.
template <class Record>
class RecordWindow {
 public:
  /// @return false if the record is not later than the one before: it is dropped
  bool add(const Record& record) {
    if (stamps_.last() && record.time <= *stamps_.last()) return false;
    stamps_.add(record.time);
    records_.push_back(record);
    if (records_.size() > kMost) records_.pop_front();
    return true;
  }
  void drop_before(TimeNs time) {
    while (!records_.empty() && records_.front().time < time) records_.pop_front();
  }
  void pass(TimeNs time) {
    if (stamps_.last() && *stamps_.last() < time) stamps_.miss();
  }
  const std::deque<Record>& records() const { return records_; }
  const SensorStamps& stamps() const { return stamps_; }
  bool empty() const { return records_.empty(); }

 private:
  static constexpr std::size_t kMost = 1 << 16;  // a minute of a fast IMU
  std::deque<Record> records_;
  SensorStamps stamps_;
};

/// What the drive has from its beginning.
struct FirstMotion : Messages {
  std::optional<Trajectory> navigation;
  std::vector<double> accuracy;
  std::optional<GeodeticPoint> origin;
  std::optional<ImuData> imu;
  std::optional<WheelData> wheels;
};

/// Converts records as the tables of a drive's folder are converted. Each result comes once.
class LiveMotion {
 public:
  /// @param name          of the drive, for messages
  /// @param longest_step  s, between the records of sensors that are waited for
  LiveMotion(const DriveDescription& description, const DriveOptions& options,
             std::filesystem::path name, double longest_step);

  // False for a record that is not later than the one before: it is dropped.
  bool add(const RecordedPose& pose) { return poses_.add(pose); }
  bool add(const RecordedPosition& position) { return positions_.add(position); }
  bool add(const RecordedInertia& inertia) { return inertia_.add(inertia); }
  bool add(const WheelSpeed& speed) { return wheels_.add(speed); }

  bool has_navigation() const { return !poses_.empty() || !positions_.empty(); }
  bool has_inertia() const { return !inertia_.empty(); }

  /// Whether every sensor that the drive uses, and that is fast enough to wait for, has sent a
  /// record at a time or later. A sensor that has stopped is not waited for.
  bool reaches(TimeNs time) const;

  /// A frame ends at this time, whether all have reached it or not.
  void pass(TimeNs time);

  /// Fixes the frame `local`, the units and the sensors. Converts the records up to the first one
  /// at `until` or later.
  /// @throws InputError  as convert_navigation()
  FirstMotion begin(const LocalFrame& frame, TimeNs until);

  /// take() then has no poses.
  void leave_out_navigation() { has_navigation_ = false; }

  /// The results after those before, up to the first record at `until` or later.
  MotionData take(TimeNs until);

  bool is_by_poses() const { return by_poses_; }
  const LocalFrame& frame() const { return frame_; }
  /// Problems that came up after begin(); each of them once.
  const Messages& messages() const { return messages_; }

 private:
  bool uses_orientations() const;
  /// Tables of the records up to the first one at `until` or later.
  NavigationTables tables(TimeNs until) const;
  void take_poses(TimeNs until, MotionData& data);
  void take_imu(TimeNs until, MotionData& data);
  void take_wheels(TimeNs until, MotionData& data);
  void warn_once(const std::string& text);

  DriveDescription description_;
  DriveOptions options_;
  std::filesystem::path name_;
  TimeNs longest_step_;

  RecordWindow<RecordedPose> poses_;
  RecordWindow<RecordedPosition> positions_;
  RecordWindow<RecordedInertia> inertia_;
  RecordWindow<WheelSpeed> wheels_;

  bool has_begun_ = false;
  bool by_poses_ = false, has_navigation_ = false, has_imu_ = false, has_wheels_ = false;
  LocalFrame frame_;
  double force_scale_ = 1;
  std::optional<double> heading_;  // of the body at the last pose
  // Of the last results.
  std::optional<TimeNs> last_pose_, last_imu_, last_wheel_;
  Messages messages_;
};

}  // namespace fovea
