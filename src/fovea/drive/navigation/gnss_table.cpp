#include "fovea/drive/navigation/gnss_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fovea/drive/navigation/course.h"
#include "fovea/drive/navigation/navigation.h"
#include "fovea/drive/navigation/navigation_columns.h"
#include "fovea/drive/plausible.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

/// Orientations of imu.csv, interpolated.
class ImuOrientations {
 public:
  /// @param file  of the rows, for warnings
  ImuOrientations(CsvRows rows, const fs::path& file, const RigidMotion& T_body_imu,
                  Messages& messages)
      : rows_(std::move(rows)), R_imu_body_(T_body_imu.linear().transpose()) {
    LeftOut left_out(file, rows_);
    left_out.add_out_of_order(rows_.drop_out_of_order());
    left_out.warn(messages);
  }

  /// Rotation from the body to east-north-up; empty if the file has none near that time.
  std::optional<Eigen::Matrix3d> at(TimeNs time) const {
    if (rows_.size() == 0) return std::nullopt;
    const auto after = std::lower_bound(rows_.times.begin(), rows_.times.end(), time);
    const auto next = static_cast<std::size_t>(after - rows_.times.begin());
    const std::size_t last = std::min(next, rows_.size() - 1), first = next == 0 ? 0 : next - 1;
    const auto q0 = quaternion_of(rows_, first, 0), q1 = quaternion_of(rows_, last, 0);
    const TimeNs t0 = rows_.times[first], t1 = rows_.times[last];
    if (!q0 || !q1 || time < t0 - kFarthest || time > t1 + kFarthest || t1 - t0 > 2 * kFarthest) {
      return std::nullopt;
    }
    const double share = t1 == t0 ? 0 : std::clamp(seconds(time - t0) / seconds(t1 - t0), 0.0, 1.0);
    return q0->slerp(share, *q1).toRotationMatrix() * R_imu_body_;
  }

 private:
  static constexpr TimeNs kFarthest = kNsPerSecond / 10;  // between a position and an orientation
  CsvRows rows_;
  Eigen::Matrix3d R_imu_body_;
};

using namespace position_column;

/// Why a line has no position that can be used, for LeftOut; empty if it has one.
std::string place_problem(const CsvRows& rows, std::size_t row) {
  const double latitude = rows.at(row, kLatitude), longitude = rows.at(row, kLongitude),
               altitude = rows.at(row, kAltitude);
  if (!std::isfinite(latitude + longitude + altitude)) return "without a position";
  if (std::abs(latitude) > 90 && std::abs(latitude) <= 180 && std::abs(longitude) <= 90) {
    return "with a latitude over 90 degrees, likely swapped with the longitude";
  }
  if (std::abs(latitude) > 90 || std::abs(longitude) > 180) return "with no angles in degrees";
  if (std::abs(altitude) > kMaxAltitude) return "with an altitude out of range";
  if (is_null_position(latitude, longitude)) return "without a fix (latitude and longitude 0)";
  return "";
}

/// As GeodeticPose has it. A line with 0 satellites or a negative status (as in
/// sensor_msgs/NavSatStatus) has no fix.
double position_accuracy(const CsvRows& rows, std::size_t row) {
  const bool has_fix = !(rows.at(row, kSatellites) == 0) && !(rows.at(row, kStatus) < 0);
  return has_fix ? accuracy_of(rows, row, kAccuracy) : std::numeric_limits<double>::infinity();
}

/// InputError if more than a few lines have an angle of over a turn, which radians do not need.
void require_radians(const CsvRows& rows, const fs::path& file) {
  std::size_t with_angles = 0, beyond = 0;
  double largest = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    double angle = 0;
    for (const PositionColumn column : {kRoll, kPitch, kYaw}) {
      angle = std::max(angle, std::abs(rows.at(row, column)));  // NaN never counts
    }
    with_angles += std::isfinite(rows.at(row, kYaw)) ? 1 : 0;
    beyond += angle > kMaxAngle ? 1 : 0;
    largest = std::max(largest, angle);
  }
  constexpr std::size_t kFew = 10;  // percent: single damaged lines
  if (100 * beyond <= kFew * with_angles) return;
  throw InputError(
      fmt::format("roll, pitch or yaw of {} lines exceed a turn (up to {:g}): likely degrees",
                  beyond, largest),
      file.string(), "give radians from -pi to pi; yaw 0 is east and grows counter-clockwise");
}

/// The attitude that the line itself gives, if any.
std::optional<Eigen::Matrix3d> own_attitude(const CsvRows& rows, std::size_t row) {
  if (const auto q = quaternion_of(rows, row, kQx)) return q->toRotationMatrix();
  OxtsRecord angles;
  angles.roll = rows.at(row, kRoll);
  angles.pitch = rows.at(row, kPitch);
  angles.yaw = rows.at(row, kYaw);
  for (const double angle : {angles.roll, angles.pitch, angles.yaw}) {
    if (!(std::abs(angle) <= kMaxAngle)) return std::nullopt;
  }
  return angles.R_enu_imu();
}

/// Lays the body level along its way; false if it never moves, and no heading is known from before.
bool take_courses(std::vector<GeodeticPose>& poses, std::optional<double> heading_before) {
  const LocalTangentPlane local(poses.front().position);
  std::vector<TimeNs> times;
  std::vector<Eigen::Vector3d> places;
  for (const GeodeticPose& pose : poses) {
    times.push_back(pose.time);
    places.emplace_back(local.T_local_enu(pose.position).translation());
  }
  const auto headings = course_headings(times, places, heading_before);
  if (!headings) return false;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].R_enu_body =
        Eigen::AngleAxisd((*headings)[i], Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  return true;
}

/// A line of gnss.csv.
struct GnssLine {
  GeodeticPose pose;
  bool has_attitude = false;
  int number = 0;
};

/// The lines that have a position; the others are left out.
std::vector<GnssLine> lines_with_position(const CsvRows& rows, const DriveDescription& drive,
                                          const std::optional<ImuOrientations>& imu,
                                          LeftOut& left_out) {
  const RigidMotion T_body_antenna(Eigen::Translation3d(drive.antenna_body));
  std::vector<GnssLine> lines;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (const std::string problem = place_problem(rows, row); !problem.empty()) {
      left_out.add(rows.lines[row], problem);
      continue;
    }
    GnssLine& line = lines.emplace_back();
    line.number = rows.lines[row];
    GeodeticPose& pose = line.pose;
    pose.time = rows.times[row];
    pose.position = {rows.at(row, kLatitude), rows.at(row, kLongitude), rows.at(row, kAltitude)};
    pose.accuracy = position_accuracy(rows, row);
    if (const auto velocity = velocity_of(rows, row, kVelocity)) {
      pose.velocity = twist_of_part(*velocity, T_body_antenna);
    }
    std::optional<Eigen::Matrix3d> R = own_attitude(rows, row);
    if (!R && imu) R = imu->at(pose.time);
    line.has_attitude = R.has_value();
    if (R) pose.R_enu_body = *R;
  }
  return lines;
}

/// Leaves out the positions that are far from the others.
void leave_out_far_positions(std::vector<GnssLine>& lines, LeftOut& left_out) {
  std::vector<GeodeticPose> poses;
  poses.reserve(lines.size());
  for (const GnssLine& line : lines) poses.push_back(line.pose);
  const std::vector<bool> far = far_positions(poses);
  std::vector<GnssLine> kept;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (far[i]) {
      left_out.add(lines[i].number, "with a position too far from the others");
    } else {
      kept.push_back(lines[i]);
    }
  }
  lines = std::move(kept);
}

/// What is missing for poses, if there are none.
std::string what_lacks(const std::vector<GnssLine>& lines) {
  if (lines.empty()) return "position that can be used";
  const bool like_radians = std::all_of(lines.begin(), lines.end(), [](const GnssLine& line) {
    return std::abs(line.pose.position.latitude) <= std::numbers::pi / 2 &&
           std::abs(line.pose.position.longitude) <= std::numbers::pi;
  });
  return std::string("attitude and never moves by a meter") +
         (like_radians ? " (latitude and longitude in radians?)" : "");
}

/// The poses of lines with an attitude. If no line has one, the vehicle heads along its way; a note
/// states that. Empty if it never moves then.
std::vector<GeodeticPose> oriented_poses(const std::vector<GnssLine>& lines, const fs::path& file,
                                         std::optional<double> heading_before, LeftOut& left_out,
                                         Messages& messages) {
  std::vector<GeodeticPose> poses;
  for (const GnssLine& line : lines) {
    if (line.has_attitude) poses.push_back(line.pose);
  }
  if (!poses.empty()) {
    for (const GnssLine& line : lines) {
      if (!line.has_attitude) left_out.add(line.number, "without an attitude");
    }
    return poses;
  }
  for (const GnssLine& line : lines) poses.push_back(line.pose);
  if (poses.empty() || !take_courses(poses, heading_before)) return {};
  messages.warn(file.string() +
                " has no attitude: headings are those of the way, roll and pitch 0");
  return poses;
}

}  // namespace

GenericNavigation convert_positions(NavigationTables tables, const fs::path& folder,
                                    const DriveDescription& drive, const LocalFrame& frame) {
  const fs::path file = folder / "gnss.csv";
  GenericNavigation result;
  CsvRows& rows = *tables.positions;
  require_radians(rows, file);
  LeftOut left_out(file, rows);
  left_out.add_out_of_order(rows.drop_out_of_order());
  std::optional<ImuOrientations> imu;
  if (tables.orientations) {
    imu.emplace(std::move(*tables.orientations), folder / "imu.csv", drive.T_body_imu, result);
  }
  std::vector<GnssLine> lines = lines_with_position(rows, drive, imu, left_out);
  leave_out_far_positions(lines, left_out);
  const std::string lack = what_lacks(lines);
  const auto poses = oriented_poses(lines, file, tables.heading_before, left_out, result);
  left_out.warn(result);
  result.headings_by_way = std::none_of(lines.begin(), lines.end(),
                                        [](const GnssLine& line) { return line.has_attitude; });
  if (poses.empty()) {
    result.warn(fmt::format("{} has no {}: no navigation, the map will not be georeferenced",
                            file.string(), lack));
    return result;
  }
  const RigidMotion T_body_antenna(Eigen::Translation3d(drive.antenna_body)),
      T_antenna_lidar = T_body_antenna.inverse() * drive.T_body_lidar;
  result.frame = frame;
  if (!frame.point) result.frame.point = lidar_position(poses, T_antenna_lidar, frame.time);
  Navigation navigation = navigation_around(*result.frame.point, poses, T_antenna_lidar);
  if (!navigation.origin) result.warn(no_fix_note(file));
  result.T_local_lidar = std::move(navigation.trajectory);
  result.accuracy = std::move(navigation.accuracy);
  result.origin = navigation.origin;
  return result;
}

}  // namespace fovea
