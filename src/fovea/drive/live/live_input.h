// The data of a live source, from their arrival to the frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/live/beginning_data.h"
#include "fovea/drive/live/frame_queue.h"
#include "fovea/drive/live/live_motion.h"
#include "fovea/drive/live/live_sensors.h"
#include "fovea/drive/live/live_source.h"
#include "fovea/drive/live/sensor_clocks.h"
#include "fovea/drive/live/sensor_watch.h"

namespace fovea {

/// Not for several threads: the source locks. Nothing waits here.
class LiveInput {
 public:
  /// @param description, options  must outlive this
  LiveInput(const DriveDescription& description, const LiveOptions& options);

  // Data as they arrive. Those that cannot be used are counted.

  /// @param further  place among the further LiDARs; absent: of the first LiDAR
  /// @param arrival  ns, on a clock that never jumps
  void add_scan(std::optional<std::size_t> further, LiveScan scan, TimeNs arrival);
  /// @param camera  place in drive.toml
  void add_image(std::size_t camera, LiveImage image, TimeNs arrival);
  /// @param sensor  number of a source of poses or positions, the IMU or the wheels
  /// @return the record with its time on the clock of the drive; absent if it cannot be used
  template <class Record>
  std::optional<Record> add_motion(std::size_t sensor, Record record, TimeNs arrival) {
    ++figures_.poses;
    const std::optional<TimeNs> time = clocks_.time_of(sensor, record.time, arrival);
    if (time) {
      record.time = *time;
      watch_.add(sensor, record.time);
      if (motion_.add(record)) return record;
    }
    ++figures_.poses_late;
    return std::nullopt;
  }

  bool has_room_for_scan(std::optional<std::size_t> further) const {
    return further ? queue_.has_room_for_further_scan(*further) : queue_.has_room_for_scan();
  }
  bool has_room_for_image(std::size_t camera) const { return queue_.has_room_for_image(camera); }

  /// Of the first scan; absent before it.
  const std::optional<WallClock::time_point>& first_arrival() const { return first_arrival_; }
  std::vector<std::string> missing() const {
    return missing_data(queue_, motion_, description_, options_);
  }
  FirstData first_data() const {
    return fovea::first_data(queue_, description_, options_.first_scans);
  }

  /// From now on, only the sensors of the beginning count for frames.
  void use(const LiveBeginning& beginning);
  /// The first frames are taken: converts their motion, and adds it to the beginning.
  /// @throws InputError  as convert_navigation()
  void begin(std::span<const RawFrame> first_frames, LiveBeginning& beginning);

  bool has_scan() const { return !queue_.scans().empty(); }
  /// Of the oldest scan. There is one.
  WallClock::time_point oldest_arrival() const { return queue_.scans().front().arrival; }
  /// Whether all sensors have sent what belongs to the oldest scan. There is one.
  bool is_frame_complete() const;
  /// Removes the oldest scan with its images, without its motion.
  RawFrame take_frame();
  /// The motion up to the end of a frame, since the frame before.
  MotionData take_motion(const RawFrame& frame);
  /// The next frame gets the motion of a frame that is skipped.
  void give_back(MotionData motion) { motion_.give_back(std::move(motion)); }

  const LocalFrame& local_frame() const { return motion_.navigation().frame(); }
  LiveFigures figures() const;

 private:
  TimeNs end_of_sweep(TimeNs stamp) const { return stamp + sweep_end_; }

  const DriveDescription& description_;
  const LiveOptions& options_;
  const LiveSensors sensors_{description_};
  FrameQueue queue_;
  LiveMotion motion_;
  SensorWatch watch_;
  SensorClocks clocks_;
  std::optional<WallClock::time_point> first_arrival_;
  TimeNs sweep_end_ = 0;  // from the stamp of a scan
  LiveFigures figures_;
};

}  // namespace fovea
