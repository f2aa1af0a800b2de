// Text of poses.csv, gnss.csv, imu.csv and wheels.csv (docs/drives.md).
#pragma once

#include <map>
#include <string>

#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// A line, with its end.
std::string table_row(const RecordedPose& pose);
/// @param has_velocities  whether the table has their columns
std::string table_row(const RecordedPosition& position, bool has_velocities);
std::string table_row(const RecordedInertia& inertia);
std::string table_row(const WheelSpeed& wheel);

// The first lines.
inline constexpr const char* kPosesHeader = "time_ns,x,y,z,qx,qy,qz,qw\n";
inline constexpr const char* kPositionsHeader =
    "time_ns,latitude,longitude,altitude,accuracy,roll,pitch,yaw\n";
inline constexpr const char* kMovingPositionsHeader =
    "time_ns,latitude,longitude,altitude,accuracy,roll,pitch,yaw,vx,vy,vz,wx,wy,wz\n";
inline constexpr const char* kInertiaHeader = "time_ns,qx,qy,qz,qw,wx,wy,wz,ax,ay,az\n";
inline constexpr const char* kWheelsHeader = "time_ns,speed\n";

/// Texts by name of the file.
using MotionTables = std::map<std::string, std::string>;

/// The tables that are not empty.
MotionTables motion_tables(const RecordedDrive& drive);

}  // namespace fovea
