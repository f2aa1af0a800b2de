// Scans as packets of Velodyne LiDARs: VelodyneScan of velodyne_driver. The VLP-16 and the VLP-32
// (VLP-32C) need no file of their calibration.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "fovea/core/point_formats/cloud_rows.h"
#include "fovea/drive/recordings/ros_messages.h"

namespace fovea::ros {

inline constexpr std::string_view kVelodyneScan = "velodyne_msgs/msg/VelodyneScan";

struct VelodynePacket {
  TimeNs stamp = 0;
  std::string_view data;  ///< 1206 bytes
};
struct VelodyneScan {
  Header header;
  std::vector<VelodynePacket> packets;
};
VelodyneScan read_velodyne_scan(MessageReader& message);

/// Passes on x, y, z (m; x ahead, y left), intensity, ring (from below) and time (s from the stamp
/// of the scan) of each return. InputError that names `where` for packets of another LiDAR, which
/// names the driver to use, and for damaged packets.
void read_rows(const VelodyneScan& scan, const std::string& where, CloudRows& rows);

}  // namespace fovea::ros
