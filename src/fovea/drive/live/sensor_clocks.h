// Clocks of sensors that jump.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/live/sensor_stamps.h"

namespace fovea {

/// Shifts the stamps of sensors so that time increases.
///
/// - A sensor whose stamps go back by over half a second, twice in a row, has jumped. Its later
///   stamps are shifted by the amount. Sensors that jump by the same amount, such as those of one
///   computer, get the same shift: their stamps keep their distances.
/// - Stamps that go ahead of the arrivals by over half a second are a pause if those of the LiDAR
/// do
///   so, too. Otherwise the sensor has jumped alone, or the LiDAR has. Then the sensor is shifted,
///   after several messages that show it.
/// - A single message with another time is dropped.
class SensorClocks {
 public:
  /// @param names         of all sensors; the first one is the LiDAR
  /// @param has_arrivals  whether data come at the rate at which they are measured
  SensorClocks(std::vector<std::string> names, bool has_arrivals);

  /// The shifted stamp; absent if the message is dropped.
  /// @param number   of the sensor
  /// @param arrival  on another clock, which never jumps
  std::optional<TimeNs> time_of(std::size_t number, TimeNs stamp, TimeNs arrival);

  const Messages& messages() const { return messages_; }

 private:
  struct Moment {
    TimeNs stamp = 0, arrival = 0;
  };
  /// Stamps that are ahead of their arrival.
  struct Ahead {
    TimeNs amount = 0, since = 0;  // since: arrival
    int messages = 0;
  };
  struct Sensor {
    std::string name;
    SensorStamps stamps;      // as they come, since the last jump
    TimeNs last_arrival = 0;  // of the last stamp
    std::size_t common_shift = 0;
    TimeNs own_shift = 0;
    std::optional<Moment> back;  // of the first message after a jump back
    std::optional<Ahead> ahead;
    std::optional<Ahead> behind;  // while the LiDAR is ahead of it
    /// Shifted stamps less arrivals, less those of the LiDAR: the latest ones.
    std::deque<TimeNs> offsets;
  };
  /// A jump back of one sensor or of several.
  struct CommonShift {
    TimeNs total = 0, amount = 0;
    std::string first;  // sensor
    bool is_reported = false;
    int lidar_messages = 0;  // since, without the jump
  };

  bool is_lidar(const Sensor& sensor) const { return &sensor == &sensors_.front(); }
  TimeNs shifted(const Sensor& sensor, TimeNs stamp) const {
    return stamp + common_shifts_[sensor.common_shift].total + sensor.own_shift;
  }
  /// Time between the last message and one that has arrived, by the rate of the sensor.
  TimeNs elapsed(const Sensor& sensor, TimeNs arrival) const;
  /// How far its stamps are ahead of those of the LiDAR, more than before; absent: not known.
  std::optional<TimeNs> deviation(const Sensor& sensor, const Moment& now) const;
  std::optional<TimeNs> accept(Sensor& sensor, const Moment& now);
  std::optional<TimeNs> go_back(Sensor& sensor, const Moment& now);
  std::optional<TimeNs> go_ahead(Sensor& sensor, const Moment& now);
  void switch_clock(Sensor& sensor, TimeNs amount);
  void follow_lidar(Sensor& sensor, const Moment& now);
  void report_lone_jumps();
  void warn(const std::string& sensor, const char* direction, TimeNs amount);

  std::vector<Sensor> sensors_;
  bool has_arrivals_;
  std::vector<CommonShift> common_shifts_{{}};
  std::optional<TimeNs> lidar_offset_;  // shifted stamp less arrival of the last scan
  TimeNs lidar_ahead_ = 0;              // by its last jump ahead
  bool is_lidar_ahead_reported_ = false;
  Messages messages_;
};

}  // namespace fovea
