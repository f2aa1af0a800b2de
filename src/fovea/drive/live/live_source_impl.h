// The threads of a live source: locks, waits, and the state that they share.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/drive/live/first_frames.h"
#include "fovea/drive/live/live_motion.h"
#include "fovea/drive/live/live_recorder.h"
#include "fovea/drive/live/live_sensors.h"
#include "fovea/drive/live/live_source.h"
#include "fovea/drive/live/sensor_clocks.h"
#include "fovea/drive/live/sensor_watch.h"

namespace fovea {

/// See LiveSource, whose functions these are.
class LiveSource::Impl {
 public:
  Impl(std::string_view drive_toml, const LiveOptions& options);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void add_scan(LiveScan scan);
  void add_image(LiveImage image);
  void add_pose(const RecordedPose& pose) { add_motion(sensors_.poses(), pose); }
  void add_position(const RecordedPosition& p) { add_motion(sensors_.positions(), p); }
  void add_inertia(const RecordedInertia& inertia) { add_motion(sensors_.imu(), inertia); }
  void add_wheel_speed(const WheelSpeed& speed) { add_motion(sensors_.wheels(), speed); }
  void close();
  void finish_recording();

  std::unique_ptr<FrameSource> begin(const std::stop_token& stop);
  std::optional<LiveFrame> next(const std::stop_token& stop);

  std::string missing() const;
  std::optional<Eigen::Vector3d> world_origin() const;
  LiveFigures figures() const;

 private:
  static TimeNs wall_clock_now() {
    return std::chrono::nanoseconds(WallClock::now().time_since_epoch()).count();
  }
  static WallClock::duration wall_time(double seconds) {
    return std::chrono::duration_cast<WallClock::duration>(std::chrono::duration<double>(seconds));
  }
  FrameQueueLimits first_limits() const;
  /// Place among the further LiDARs; absent: the first LiDAR.
  std::optional<std::size_t> find_further_lidar(const std::string& name) const;
  std::size_t find_camera(const std::string& name) const;

  template <class Record>
  void add_motion(std::size_t sensor, Record record) {
    const TimeNs arrival = wall_clock_now();
    const std::lock_guard lock(guard_);
    if (closed_) return;
    ++figures_.poses;
    const std::optional<TimeNs> time = clocks_.time_of(sensor, record.time, arrival);
    if (!time) {
      ++figures_.poses_late;
      return;
    }
    record.time = *time;
    watch_.add(sensor, record.time);
    if (!motion_.add(record)) {
      ++figures_.poses_late;
    } else if (recorder_) {
      record_later(record);
    }
    notify();
  }

  // All below with guard_ locked.

  /// Keeps a record for the recording.
  void record_later(const RecordedPose& pose) { keep(pose, unrecorded_.poses); }
  void record_later(const RecordedPosition& position) { keep(position, unrecorded_.positions); }
  void record_later(const RecordedInertia& inertia) { keep(inertia, unrecorded_.inertia); }
  void record_later(const WheelSpeed& speed) { keep(speed, unrecorded_.wheels); }
  template <class Record>
  static void keep(const Record& record, std::vector<Record>& records) {
    constexpr std::size_t kMost = 1 << 16;
    if (records.size() < kMost) records.push_back(record);
  }

  void notify();
  /// Waits for room if the options want that. Without a scan that waits for a frame it waits for a
  /// short time only: the sender may be the thread that sends the next scan.
  /// @return false if the source is closed
  template <class HasRoom>
  bool wait_for_room(std::unique_lock<std::mutex>& lock, HasRoom&& has_room);
  /// Waits until `is_done`, or a time.
  /// @return false if `stop` is requested
  template <class IsDone>
  bool wait(std::unique_lock<std::mutex>& lock, const std::stop_token& stop,
            std::optional<WallClock::time_point> end, IsDone&& is_done);

  /// Nothing: without an end.
  std::optional<WallClock::time_point> end_of_wait(WallClock::time_point begin,
                                                   double longest) const;
  /// What begin() waits for.
  std::vector<std::string> missing_data() const;
  /// Whether images of a camera began before the last of the first scans.
  bool has_image_of_first_scans(std::size_t camera) const;
  void add_missing_images(std::vector<std::string>& missing) const;
  FirstData first_data() const;
  /// Waits until the oldest scan is a frame; nothing at the end.
  std::optional<RawFrame> take_frame(std::unique_lock<std::mutex>& lock,
                                     const std::stop_token& stop);
  TimeNs end_of_sweep(TimeNs stamp) const { return stamp + sweep_end(*decoder_); }
  void begin_watch(const LiveBeginning& beginning);
  /// Adds the motion since the frame before.
  void add_motion_to(RawFrame& raw);

  const LiveOptions options_;
  const DriveDescription description_;
  const LiveSensors sensors_{description_};

  mutable std::mutex guard_;  // of all below
  std::condition_variable_any changed_;
  std::size_t version_ = 0;  // of the data
  std::size_t callers_ = 0;  // that wait for room
  bool is_stuck_ = false;    // the only sender waits, and no frame was taken since
  bool closed_ = false;
  FrameQueue queue_;
  LiveMotion motion_;
  SensorWatch watch_;
  SensorClocks clocks_;
  std::optional<WallClock::time_point> first_arrival_;  // of a scan
  LiveFigures figures_;
  int next_index_;
  std::shared_ptr<const LiveDecoder> decoder_;
  std::vector<std::size_t> used_cameras_;  // places in drive.toml
  std::deque<RawFrame> first_frames_;      // that next() has not returned
  MotionData skipped_motion_;              // of frames that were skipped
  std::optional<LiveRecorder> recorder_;   // for the thread that maps
  RawMotion unrecorded_;
};

}  // namespace fovea
