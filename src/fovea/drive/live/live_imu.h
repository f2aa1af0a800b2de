// IMU and wheels of a live drive, from their arrival to the frames.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/live/record_window.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// Converts records as imu.csv is converted. Each sample comes once.
class LiveImu {
 public:
  /// @param description  must outlive this
  /// @param is_used      whether the drive uses an IMU
  /// @param name         of the drive, for messages
  LiveImu(const DriveDescription& description, bool is_used, std::filesystem::path name)
      : description_(description), name_(std::move(name)), is_used_(is_used && description.imu) {}

  /// The records. A frame may need their orientations although the samples are not used.
  RecordWindow<RecordedInertia>& records() { return records_; }
  const RecordWindow<RecordedInertia>& records() const { return records_; }
  bool reaches(TimeNs time, TimeNs longest_step) const {
    return !is_used_ || records_.has_reached(time, longest_step);
  }

  /// Finds the units by the records up to the first one at `until` or later, and converts these.
  /// Absent: the drive has no IMU that can be used.
  std::optional<ImuData> begin(TimeNs until, Messages& messages);
  /// The samples after those before, up to the first record at `until` or later.
  std::vector<ImuSample> take(TimeNs until);

 private:
  const DriveDescription& description_;
  std::filesystem::path name_;
  RecordWindow<RecordedInertia> records_;
  bool is_used_;
  double force_scale_ = 1;
  std::optional<TimeNs> last_;  // of the last results
};

/// The same of the wheels.
class LiveWheels {
 public:
  explicit LiveWheels(bool is_used) : is_used_(is_used) {}

  RecordWindow<WheelSpeed>& records() { return records_; }
  bool reaches(TimeNs time, TimeNs longest_step) const {
    return !is_used_ || records_.has_reached(time, longest_step);
  }
  /// Without a speed that can be used, take() has none either.
  std::vector<WheelSpeed> begin(TimeNs until);
  std::vector<WheelSpeed> take(TimeNs until);

 private:
  RecordWindow<WheelSpeed> records_;
  bool is_used_;
  std::optional<TimeNs> last_;  // of the last results
};

}  // namespace fovea
