#include "fovea/sensor/gnss_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/sensor/course.h"
#include "fovea/sensor/navigation.h"
#include "fovea/sensor/navigation_table.h"
#include "fovea/sensor/plausible.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

/// Orientations of imu.csv, interpolated.
class ImuOrientations {
 public:
  ImuOrientations(const fs::path& file, const RigidMotion& T_body_imu,
                  std::vector<std::string>& notes)
      : R_imu_body_(T_body_imu.linear().transpose()) {
    constexpr std::array<CsvColumn, 4> kColumns = {
        {{"qx", false}, {"qy", false}, {"qz", false}, {"qw", false}}};
    rows_ = read_csv(file, kColumns);
    LeftOut left_out(file, rows_);
    left_out.add_out_of_order(rows_.drop_out_of_order());
    left_out.note(notes);
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
  CsvRows rows_{4};
  Eigen::Matrix3d R_imu_body_;
};

enum GnssColumn : std::size_t {
  kLatitude,
  kLongitude,
  kAltitude,
  kGnssAccuracy,
  kRoll,
  kPitch,
  kYaw,
  kGnssQx,
  kGnssVelocity = kGnssQx + 4
};
constexpr auto kGnssNames = with_velocity<kGnssVelocity>({{{"latitude"},
                                                           {"longitude"},
                                                           {"altitude"},
                                                           {"accuracy", false},
                                                           {"roll", false},
                                                           {"pitch", false},
                                                           {"yaw", false},
                                                           {"qx", false},
                                                           {"qy", false},
                                                           {"qz", false},
                                                           {"qw", false}}});

bool has_place(const CsvRows& rows, std::size_t row) {
  // Written so that NaN fails, too.
  return std::abs(rows.at(row, kLatitude)) <= 90 && std::abs(rows.at(row, kLongitude)) <= 180 &&
         std::abs(rows.at(row, kAltitude)) <= kMaxAltitude;
}

/// The attitude that the line itself gives, if any.
std::optional<Eigen::Matrix3d> own_attitude(const CsvRows& rows, std::size_t row) {
  if (const auto q = quaternion_of(rows, row, kGnssQx)) return q->toRotationMatrix();
  OxtsRecord angles;
  angles.roll = rows.at(row, kRoll);
  angles.pitch = rows.at(row, kPitch);
  angles.yaw = rows.at(row, kYaw);
  for (const double angle : {angles.roll, angles.pitch, angles.yaw}) {
    if (!(std::abs(angle) <= kMaxAngle)) return std::nullopt;
  }
  return angles.R_enu_imu();
}

/// Lays the body level along its way; false if it never moves.
bool take_courses(std::vector<GeodeticPose>& poses) {
  const LocalTangentPlane local(poses.front().position);
  std::vector<TimeNs> times;
  std::vector<Eigen::Vector3d> places;
  for (const GeodeticPose& pose : poses) {
    times.push_back(pose.time);
    places.emplace_back(local.T_local_enu(pose.position).translation());
  }
  const auto headings = course_headings(times, places);
  if (!headings) return false;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].R_enu_body =
        Eigen::AngleAxisd((*headings)[i], Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  return true;
}

}  // namespace

GenericNavigation read_gnss(const fs::path& folder, const DriveDescription& drive,
                            TimeNs origin_time) {
  const fs::path file = folder / "gnss.csv", imu_file = folder / "imu.csv";
  GenericNavigation result;
  CsvRows rows = read_csv(file, kGnssNames);
  LeftOut left_out(file, rows);
  left_out.add_out_of_order(rows.drop_out_of_order());
  std::optional<ImuOrientations> imu;
  if (fs::exists(imu_file)) imu.emplace(imu_file, drive.T_body_imu, result.notes);

  const RigidMotion T_body_antenna(Eigen::Translation3d(drive.antenna_body));
  std::vector<GeodeticPose> level, turned;  // all places, and those of a known attitude
  std::vector<int> without_attitude;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (!has_place(rows, row)) {
      left_out.add(rows.lines[row]);
      continue;
    }
    GeodeticPose pose;
    pose.time = rows.times[row];
    pose.position = {rows.at(row, kLatitude), rows.at(row, kLongitude), rows.at(row, kAltitude)};
    pose.accuracy = accuracy_of(rows, row, kGnssAccuracy);
    if (const auto velocity = velocity_of(rows, row, kGnssVelocity)) {
      pose.velocity = twist_of_part(*velocity, T_body_antenna);
    }
    level.push_back(pose);
    std::optional<Eigen::Matrix3d> R = own_attitude(rows, row);
    if (!R && imu) R = imu->at(pose.time);
    if (R) {
      pose.R_enu_body = *R;
      turned.push_back(pose);
    } else {
      without_attitude.push_back(rows.lines[row]);
    }
  }
  const auto without = [&](const std::string& why) {
    left_out.note(result.notes);
    result.notes.push_back(why + ": no navigation, the map will not be georeferenced");
    return result;
  };
  if (level.empty()) return without(file.string() + " has no position that can be used");
  if (turned.empty()) {
    if (!take_courses(level)) {
      return without(file.string() + " has no attitude and never moves by a metre");
    }
    turned = std::move(level);
    result.notes.push_back(file.string() +
                           " has no attitude: headings are those of the way, roll and pitch 0");
  } else {
    for (const int line : without_attitude) left_out.add(line);
  }
  left_out.note(result.notes);
  Navigation navigation =
      navigation_of(turned, T_body_antenna.inverse() * drive.T_body_lidar, origin_time);
  result.T_local_lidar = std::move(navigation.trajectory);
  result.accuracy = std::move(navigation.accuracy);
  result.origin = navigation.origin;
  return result;
}

}  // namespace fovea
