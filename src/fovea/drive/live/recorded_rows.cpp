#include "fovea/drive/live/recorded_rows.h"

#include <algorithm>
#include <limits>

#include "fovea/drive/navigation/navigation_columns.h"

namespace fovea {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <std::size_t N>
CsvRows no_rows(const std::array<CsvColumn, N>& columns) {
  CsvRows rows(columns.size());
  std::fill(rows.has.begin(), rows.has.end(), true);
  return rows;
}

template <std::size_t N>
void add(CsvRows& rows, TimeNs time, const std::array<double, N>& values) {
  rows.times.push_back(time);
  rows.file_times.push_back({time, 0});
  rows.values.insert(rows.values.end(), values.begin(), values.end());
  rows.lines.push_back(static_cast<int>(rows.lines.size()) + 1);
}

/// @param to  x, y, z, w
void put(const Eigen::Quaterniond& q, double* to) {
  to[0] = q.x();
  to[1] = q.y();
  to[2] = q.z();
  to[3] = q.w();
}

}  // namespace

CsvRows pose_rows() { return no_rows(kPoseColumns); }
CsvRows position_rows() { return no_rows(kPositionColumns); }
CsvRows orientation_rows() { return no_rows(kOrientationColumns); }
CsvRows inertia_rows() { return no_rows(kInertiaColumns); }

void add_row(CsvRows& rows, const RecordedPose& pose) {
  using namespace pose_column;
  std::array<double, kPoseColumns.size()> values;
  values.fill(kNone);
  const Eigen::Vector3d& t = pose.T_world_body.translation;
  values[kX] = t.x();
  values[kY] = t.y();
  values[kZ] = t.z();
  put(pose.T_world_body.rotation, &values[kQx]);
  add(rows, pose.time, values);
}

void add_row(CsvRows& rows, const RecordedPosition& position) {
  using namespace position_column;
  std::array<double, kPositionColumns.size()> values;
  values.fill(kNone);
  values[kLatitude] = position.antenna.latitude;
  values[kLongitude] = position.antenna.longitude;
  values[kAltitude] = position.antenna.altitude;
  values[position_column::kAccuracy] = position.accuracy;
  if (const auto& angles = position.roll_pitch_yaw) {
    values[kRoll] = angles->x();
    values[kPitch] = angles->y();
    values[kYaw] = angles->z();
  }
  if (const auto& velocity = position.velocity) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      values[position_column::kVelocity + std::size_t(i)] = (*velocity)[3 + i];
      values[position_column::kVelocity + 3 + std::size_t(i)] = (*velocity)[i];
    }
  }
  add(rows, position.time, values);
}

void add_orientation(CsvRows& rows, const RecordedInertia& inertia) {
  std::array<double, kOrientationColumns.size()> values;
  values.fill(kNone);
  if (inertia.R_enu_imu) put(*inertia.R_enu_imu, values.data());
  add(rows, inertia.time, values);
}

void add_inertia(CsvRows& rows, const RecordedInertia& inertia) {
  const Eigen::Vector3d &w = inertia.angular_velocity, &a = inertia.acceleration;
  add(rows, inertia.time, std::array{w.x(), w.y(), w.z(), a.x(), a.y(), a.z()});
}

}  // namespace fovea
