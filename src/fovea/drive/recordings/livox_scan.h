// Scans of Livox LiDARs: CustomMsg of livox_ros_driver and of livox_ros_driver2.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "fovea/core/point_formats/cloud_rows.h"
#include "fovea/drive/recordings/ros_messages.h"

namespace fovea::ros {

inline constexpr std::string_view kLivox = "livox_ros_driver/msg/CustomMsg",
                                  kLivox2 = "livox_ros_driver2/msg/CustomMsg";

struct LivoxPoint {
  std::uint32_t offset_time = 0;  ///< ns after the first point
  float x = 0, y = 0, z = 0;      ///< m; zeros: nothing came back
  std::uint8_t reflectivity = 0;
};
/// Its stamp is the time of the first point.
struct LivoxScan {
  Header header;
  std::vector<LivoxPoint> points;
};
LivoxScan read_livox_scan(MessageReader& message);

/// Passes on x, y, z, intensity and time.
void read_rows(const LivoxScan& scan, CloudRows& rows);

}  // namespace fovea::ros
