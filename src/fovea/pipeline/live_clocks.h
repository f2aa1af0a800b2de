// Clocks of cameras and IMU against the LiDAR's, while a live drive is mapped.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/pipeline/calibration_check.h"

namespace fovea {

/// Estimates each minute how much later images and IMU samples are than their stamps say, by the
/// edges of images and the turns of the scans (docs/calibration.md). Corrects what is clearly off
/// in later frames, and reports offsets and drift. A standing vehicle shows neither.
///
/// A correction holds from a fixed number of frames later on, so that the map depends on the frames
/// only.
class LiveClocks {
 public:
  /// Frames of an estimate, and frames after it before its correction holds: more than the frames
  /// that are read ahead.
  static constexpr int kWindow = 600, kLag = 30;

  /// @param drive       must outlive this
  /// @param compensate  whether scans need motion compensation
  LiveClocks(const DriveInfo& drive, bool compensate);

  /// Enters the next frame. To be called by the thread that maps.
  /// @param motion  of the frame; absent: its edges are not used
  void add(const Frame& frame, const FrameRecord& record, const std::optional<FrameMotion>& motion);
  /// Whether add() uses the edges of a frame.
  bool is_due(int index) const { return check_->is_due(index); }

  /// Corrects delays and stamps of the next frame. To be called by the thread that reads.
  void correct(Frame& frame);

  /// The calibration in the first minute.
  DriveCalibration first_calibration() const { return first_ ? *first_ : check_->estimate(); }
  Messages messages() const;

 private:
  /// An offset in s that was found.
  struct Measurement {
    TimeNs time = 0;
    double offset = 0, sigma = 0;
  };
  /// A sensor whose clock may differ.
  struct Sensor {
    std::string name;
    double corrected = 0;  ///< s, sum of the corrections
    std::vector<Measurement> measured;
  };
  struct Correction {
    int from_frame = 0;
    std::vector<double> cameras;  ///< s, sums by place in the calibration
    double imu = 0;
  };
  void end_window(int frame, TimeNs time);
  void measure(Sensor& sensor, TimeNs time, double delay, double sigma);
  void report(const Sensor& sensor, Messages& messages) const;

  const DriveInfo& drive_;
  bool compensate_;
  std::optional<CalibrationCheck> check_;  // of the present window
  ImuCheck imu_check_;
  std::vector<ImuSample> samples_;
  std::optional<int> window_begin_;
  std::optional<DriveCalibration> first_;
  std::vector<Sensor> cameras_;
  Sensor imu_{"the IMU", 0, {}};
  mutable std::mutex guard_;
  std::vector<Correction> corrections_;  // guarded
  // Of the reading thread.
  TimeNs last_sample_ = 0;
};

}  // namespace fovea
