// Sensors that stop, come back, or begin late.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/live/sensor_stamps.h"

namespace fovea {

/// Compares the stamps of sensors. A time in which no sensor sends data is a pause.
class SensorWatch {
 public:
  /// @param names  of all sensors: "camera front"; the first one is the LiDAR
  explicit SensorWatch(std::vector<std::string> names);

  /// The beginning is over: reports other sensors that send data from now on.
  /// @param is_used    by sensor
  /// @param is_wanted  by sensor: whether it would be used if it had sent data
  void begin(const std::vector<bool>& is_used, const std::vector<bool>& is_wanted);
  /// A sensor is used from a time on.
  void use(std::size_t sensor, TimeNs stamp);
  /// A sensor has sent data.
  void add(std::size_t sensor, TimeNs stamp);

  const Messages& messages() const { return messages_; }

 private:
  enum class State { kBefore, kUsed, kStopped, kUnused, kReported };
  struct Sensor {
    std::string name;
    State state = State::kBefore;
    std::optional<TimeNs> last;  // stamp
    TimeNs step = 0;             // before it
    TimeNs last_clock = 0;       // when it came
  };
  /// Looks for sensors that have stopped.
  void check();
  /// s from the first scan.
  double time_of(TimeNs stamp) const { return seconds(stamp - first_.value_or(stamp)); }
  void warn(std::string text);

  std::vector<Sensor> sensors_;
  std::optional<TimeNs> first_;   // stamp of the LiDAR
  std::optional<TimeNs> newest_;  // stamp
  TimeNs clock_ = 0;              // advances with the stamps, but for pauses
  Messages messages_;
};

}  // namespace fovea
