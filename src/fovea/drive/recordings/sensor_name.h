#pragma once

#include <string>
#include <string_view>

#include "fovea/core/plain_name.h"

namespace fovea {

/// The name of a sensor from that of its topic: "/sensors/front" is sensors_front.
/// @param unnamed  the name if the topic has none
inline std::string sensor_name(std::string_view topic, std::string_view unnamed) {
  std::string name;
  for (const char c : topic) {
    if (!name.empty() || is_plain(c)) name += is_plain(c) ? c : '_';
  }
  return name.empty() ? std::string(unnamed) : name;
}

}  // namespace fovea
