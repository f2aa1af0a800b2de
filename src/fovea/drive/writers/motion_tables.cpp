#include "fovea/drive/writers/motion_tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace fovea {

std::string table_row(const RecordedPose& pose) {
  const Eigen::Vector3d& t = pose.T_world_body.translation;
  const Eigen::Quaterniond& q = pose.T_world_body.rotation;
  return fmt::format("{},{},{},{},{},{},{},{}\n", pose.time, t.x(), t.y(), t.z(), q.x(), q.y(),
                     q.z(), q.w());
}

std::string table_row(const RecordedPosition& position, bool has_velocities) {
  const GeodeticPoint& p = position.antenna;
  std::string text = fmt::format("{},{},{},{},{}", position.time, p.latitude, p.longitude,
                                 p.altitude, position.accuracy);
  if (const auto& angles = position.roll_pitch_yaw) {
    text += fmt::format(",{},{},{}", angles->x(), angles->y(), angles->z());
  } else {
    text += ",,,";
  }
  if (const auto& v = position.velocity) {
    text += fmt::format(",{},{},{},{},{},{}", (*v)[3], (*v)[4], (*v)[5], (*v)[0], (*v)[1], (*v)[2]);
  } else if (has_velocities) {
    text += ",,,,,,";
  }
  return text + '\n';
}

std::string table_row(const RecordedInertia& inertia) {
  const Eigen::Vector3d &w = inertia.angular_velocity, &a = inertia.acceleration;
  std::string text = fmt::format("{}", inertia.time);
  if (const auto& q = inertia.R_enu_imu) {
    text += fmt::format(",{},{},{},{}", q->x(), q->y(), q->z(), q->w());
  } else {
    text += ",,,,";
  }
  return text + fmt::format(",{},{},{},{},{},{}\n", w.x(), w.y(), w.z(), a.x(), a.y(), a.z());
}

std::string table_row(const WheelSpeed& wheel) {
  return fmt::format("{},{}\n", wheel.time, wheel.speed);
}

MotionTables motion_tables(const RecordedDrive& drive) {
  MotionTables tables;
  const auto add = [&](const char* name, const char* header, const auto& records, auto&& row) {
    if (records.empty()) return;
    std::string& text = tables[name];
    text = header;
    for (const auto& record : records) text += row(record);
  };
  const auto plain = [](const auto& record) { return table_row(record); };
  const bool has_velocities =
      std::any_of(drive.positions.begin(), drive.positions.end(),
                  [](const RecordedPosition& position) { return position.velocity.has_value(); });
  add("poses.csv", kPosesHeader, drive.poses, plain);
  add("gnss.csv", has_velocities ? kMovingPositionsHeader : kPositionsHeader, drive.positions,
      [&](const RecordedPosition& position) { return table_row(position, has_velocities); });
  add("imu.csv", kInertiaHeader, drive.inertia, plain);
  add("wheels.csv", kWheelsHeader, drive.wheels, plain);
  return tables;
}

}  // namespace fovea
