// A message with a scan, of any type that is read.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "fovea/drive/recordings/livox_scan.h"
#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/drive/recordings/velodyne_scan.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/drive/scans/scan_format.h"

namespace fovea {

/// Whether messages of this type are scans that are read.
bool is_scan_type(std::string_view type);

/// Points into the message that it is read from.
class ScanMessage {
 public:
  /// @param type  for which is_scan_type() holds
  /// InputError as MessageReader.
  ScanMessage(std::string_view type, MessageReader& message);

  const ros::Header& header() const;
  /// Passes the points on. InputError that names `where` for points that cannot be read.
  void read(const std::string& where, CloudRows& rows) const;

 private:
  std::variant<ros::PointCloud2, ros::LivoxScan, ros::VelodyneScan> message_;
};

/// The points of a message. InputError that names `where` for points that cannot be read, or of
/// which none can be used.
LidarScan scan_of(const ScanMessage& message, const ScanFormat& format, const std::string& where);

/// The driver that makes point clouds of packets of this type; empty for other types.
std::string_view driver_of_packets(std::string_view type);

}  // namespace fovea
