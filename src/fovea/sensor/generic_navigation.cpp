#include "fovea/sensor/generic_navigation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/sensor/course.h"
#include "fovea/sensor/csv_rows.h"
#include "fovea/sensor/measured_velocity.h"
#include "fovea/sensor/navigation.h"
#include "fovea/sensor/plausible.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxWorldCoordinate = 1e8;  // m: any map projection's, earth-centred ones, too

/// The rotation of the quaternion x y z w in four columns from `first` on; empty if that is none.
std::optional<Eigen::Quaterniond> quaternion_of(const CsvRows& rows, std::size_t row,
                                                std::size_t first) {
  const Eigen::Quaterniond q(rows.at(row, first + 3), rows.at(row, first), rows.at(row, first + 1),
                             rows.at(row, first + 2));
  if (!(std::abs(q.norm() - 1) < 0.01)) return std::nullopt;  // NaN, too
  return q.normalized();
}

/// Lines that cannot be used, for a note.
class LeftOut {
 public:
  LeftOut(const fs::path& file, const CsvRows& rows) : file_(file), malformed_(rows.malformed) {}

  void add(int line) { malformed_.push_back(line); }
  void add_out_of_order(std::size_t count) { out_of_order_ = count; }

  void warn(Messages& messages) const {
    if (!malformed_.empty()) {
      messages.warn(fmt::format("{} lines of {} cannot be used (the first: {})", malformed_.size(),
                                file_.string(),
                                *std::min_element(malformed_.begin(), malformed_.end())));
    }
    if (out_of_order_ > 0) {
      messages.warn(fmt::format("{} lines of {} are out of order and not used", out_of_order_,
                                file_.string()));
    }
  }

 private:
  fs::path file_;
  std::vector<int> malformed_;
  std::size_t out_of_order_ = 0;
};

/// A table's columns, and after them those of a velocity.
template <std::size_t N>
constexpr std::array<CsvColumn, N + 6> with_velocity(const std::array<CsvColumn, N>& columns) {
  std::array<CsvColumn, N + 6> all{};
  std::size_t next = 0;
  for (const CsvColumn& column : columns) all[next++] = column;
  for (const char* name : {"vx", "vy", "vz", "wx", "wy", "wz"}) all[next++] = {name, false};
  return all;
}

/// The velocity in six columns from `first` on, where the line has one.
std::optional<Twist> velocity_of(const CsvRows& rows, std::size_t row, std::size_t first) {
  const auto vector = [&](std::size_t column) {
    return Eigen::Vector3d(rows.at(row, column), rows.at(row, column + 1),
                           rows.at(row, column + 2));
  };
  return measured_velocity(vector(first + 3), vector(first));
}

/// Standard deviation as DriveInfo has it: 0 where the file says nothing.
double accuracy_of(const CsvRows& rows, std::size_t row, std::size_t column) {
  const double accuracy = rows.at(row, column);
  return std::isnan(accuracy) ? 0 : std::max(0.0, accuracy);
}

GenericNavigation read_pose_table(const fs::path& file, const DriveDescription& drive,
                                  TimeNs origin_time) {
  enum { kX, kY, kZ, kQx, kAccuracy = 7, kVelocity };
  constexpr auto kColumns = with_velocity<kVelocity>(
      {{{"x"}, {"y"}, {"z"}, {"qx"}, {"qy"}, {"qz"}, {"qw"}, {"accuracy", false}}});
  GenericNavigation result;
  CsvRows rows = read_csv(file, kColumns);
  LeftOut left_out(file, rows);
  left_out.add_out_of_order(rows.drop_out_of_order());
  std::vector<StampedPose> poses;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Eigen::Vector3d position(rows.at(row, kX), rows.at(row, kY), rows.at(row, kZ));
    const auto q = quaternion_of(rows, row, kQx);
    // The largest of numbers and a NaN may be a number.
    if (!q || !position.allFinite() || position.cwiseAbs().maxCoeff() > kMaxWorldCoordinate) {
      left_out.add(rows.lines[row]);
      continue;
    }
    RigidMotion T_world_body(*q);
    T_world_body.pretranslate(position);
    poses.push_back({rows.times[row], T_world_body * drive.T_body_lidar, {}});
    if (const auto velocity = velocity_of(rows, row, kVelocity)) {
      poses.back().velocity = twist_of_part(*velocity, drive.T_body_lidar);
    }
    result.accuracy.push_back(accuracy_of(rows, row, kAccuracy));
  }
  left_out.warn(result);
  if (poses.empty()) {
    result.warn(file.string() + " has no pose that can be used: no navigation");
    return result;
  }
  const Trajectory T_world_lidar(poses);
  const Eigen::Vector3d origin =
      T_world_lidar.at(origin_time).value_or(poses.front().T_local_body).translation();
  for (StampedPose& pose : poses) pose.T_local_body.pretranslate(-origin);
  result.T_local_lidar.emplace(std::move(poses));
  return result;
}

/// Orientations of imu.csv, interpolated.
class ImuOrientations {
 public:
  ImuOrientations(const fs::path& file, const RigidMotion& T_body_imu, Messages& messages)
      : R_imu_body_(T_body_imu.linear().transpose()) {
    constexpr std::array<CsvColumn, 4> kColumns = {
        {{"qx", false}, {"qy", false}, {"qz", false}, {"qw", false}}};
    rows_ = read_csv(file, kColumns);
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

GenericNavigation read_gnss(const fs::path& folder, const DriveDescription& drive,
                            TimeNs origin_time) {
  const fs::path file = folder / "gnss.csv", imu_file = folder / "imu.csv";
  GenericNavigation result;
  CsvRows rows = read_csv(file, kGnssNames);
  LeftOut left_out(file, rows);
  left_out.add_out_of_order(rows.drop_out_of_order());
  std::optional<ImuOrientations> imu;
  if (fs::exists(imu_file)) imu.emplace(imu_file, drive.T_body_imu, result);

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
    left_out.warn(result);
    result.warn(why + ": no navigation, the map will not be georeferenced");
    return result;
  };
  if (level.empty()) return without(file.string() + " has no position that can be used");
  if (turned.empty()) {
    if (!take_courses(level)) {
      return without(file.string() + " has no attitude and never moves by a metre");
    }
    turned = std::move(level);
    result.warn(file.string() +
                " has no attitude: headings are those of the way, roll and pitch 0");
  } else {
    for (const int line : without_attitude) left_out.add(line);
  }
  left_out.warn(result);
  Navigation navigation =
      navigation_of(turned, T_body_antenna.inverse() * drive.T_body_lidar, origin_time);
  result.T_local_lidar = std::move(navigation.trajectory);
  result.accuracy = std::move(navigation.accuracy);
  result.origin = navigation.origin;
  return result;
}

}  // namespace

GenericNavigation read_generic_navigation(const fs::path& folder, const DriveDescription& drive,
                                          TimeNs origin_time) {
  if (fs::exists(folder / "poses.csv")) {
    return read_pose_table(folder / "poses.csv", drive, origin_time);
  }
  if (fs::exists(folder / "gnss.csv")) return read_gnss(folder, drive, origin_time);
  GenericNavigation none;
  none.notes.push_back("the drive has neither poses.csv nor gnss.csv: no navigation");
  return none;
}

}  // namespace fovea
