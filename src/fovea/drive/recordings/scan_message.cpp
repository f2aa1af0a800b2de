#include "fovea/drive/recordings/scan_message.h"

#include <array>

#include "fovea/drive/recordings/point_cloud_rows.h"

namespace fovea {

bool is_scan_type(std::string_view type) {
  return type == ros::kPointCloud || type == ros::kLivox || type == ros::kLivox2 ||
         type == ros::kVelodyneScan;
}

ScanMessage::ScanMessage(std::string_view type, MessageReader& message) {
  if (type == ros::kPointCloud) {
    message_ = ros::read_point_cloud(message);
  } else if (type == ros::kVelodyneScan) {
    message_ = ros::read_velodyne_scan(message);
  } else {
    message_ = ros::read_livox_scan(message);
  }
}

const ros::Header& ScanMessage::header() const {
  return std::visit([](const auto& message) -> const ros::Header& { return message.header; },
                    message_);
}

void ScanMessage::read(const std::string& where, CloudRows& rows) const {
  if (const auto* cloud = std::get_if<ros::PointCloud2>(&message_)) {
    read_cloud_rows(*cloud, where, rows);
  } else if (const auto* livox = std::get_if<ros::LivoxScan>(&message_)) {
    ros::read_rows(*livox, rows);
  } else {
    ros::read_rows(std::get<ros::VelodyneScan>(message_), where, rows);
  }
}

LidarScan scan_of(const ScanMessage& message, const ScanFormat& format, const std::string& where) {
  ScanRows rows(format, message.header().stamp);
  message.read(where, rows);
  return rows.take(where);
}

std::string_view driver_of_packets(std::string_view type) {
  struct Packets {
    std::string_view type, driver;
  };
  constexpr std::array<Packets, 14> kPackets = {{
      {"velodyne_msgs/msg/VelodynePacket", "velodyne_pointcloud"},
      {"ouster_ros/msg/PacketMsg", "ouster_ros"},
      {"ouster_msgs/msg/PacketMsg", "ouster_ros"},
      {"ouster_sensor_msgs/msg/PacketMsg", "ouster_ros"},
      {"hesai_ros_driver/msg/UdpFrame", "hesai_ros_driver"},
      {"hesai_ros_driver/msg/UdpPacket", "hesai_ros_driver"},
      {"hesai_lidar/msg/PandarScan", "hesai_lidar"},
      {"pandar_msgs/msg/PandarScan", "hesai_pandar"},
      {"nebula_msgs/msg/NebulaPackets", "nebula"},
      {"rslidar_msg/msg/RslidarPacket", "rslidar_sdk"},
      {"rslidar_msg/msg/RslidarScan", "rslidar_sdk"},
      {"rslidar_msgs/msg/rslidarScan", "rslidar_sdk"},
      {"rslidar_msgs/msg/rslidarPacket", "rslidar_sdk"},
      {"lslidar_msgs/msg/LslidarPacket", "lslidar_driver"},
  }};
  for (const Packets& packets : kPackets) {
    if (packets.type == type) return packets.driver;
  }
  return {};
}

}  // namespace fovea
