// Sensors that stop, come back, or begin late.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/live/sensor_stamps.h"

namespace fovea {

/// Compares the stamps of sensors with those of the LiDAR.
class SensorWatch {
 public:
  /// @param names  of all sensors: "camera front"; the first one is the LiDAR
  explicit SensorWatch(std::vector<std::string> names);

  /// The beginning is over: reports other sensors that send data from now on.
  /// @param is_used    by sensor
  /// @param is_wanted  by sensor: whether it would be used if it had sent data
  void begin(const std::vector<bool>& is_used, const std::vector<bool>& is_wanted);
  /// A sensor has sent data.
  void add(std::size_t sensor, TimeNs stamp);

  const Messages& messages() const { return messages_; }

 private:
  enum class State { kBefore, kUsed, kStopped, kUnused, kReported };
  struct Sensor {
    std::string name;
    State state = State::kBefore;
    std::optional<TimeNs> last;  // stamp
  };
  /// Looks for sensors that have stopped.
  void check(TimeNs now);
  void warn(std::string text);

  std::vector<Sensor> sensors_;
  std::optional<TimeNs> first_;  // stamp of the LiDAR
  Messages messages_;
};

}  // namespace fovea
