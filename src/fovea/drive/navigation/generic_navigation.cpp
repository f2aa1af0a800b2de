#include "fovea/drive/navigation/generic_navigation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/median.h"
#include "fovea/drive/navigation/gnss_table.h"
#include "fovea/drive/navigation/navigation_columns.h"
#include "fovea/errors.h"
#include "fovea/geometry/position_limit.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxWorldCoordinate = 1e8;  // m: any map projection's, earth-centred ones, too

/// The middle one of the positions of all rows, axis by axis: one damaged row does not move it.
Eigen::Vector3d median_position(const CsvRows& rows) {
  Eigen::Vector3d median = Eigen::Vector3d::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (std::isfinite(rows.at(row, axis))) values.push_back(rows.at(row, axis));
    }
    if (values.empty()) continue;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[static_cast<Eigen::Index>(axis)] = *middle;
  }
  return median;
}

/// Median speed of a motion from line to line, m/s.
template <class Motion>
double median_speed(const std::vector<StampedPose>& poses, Motion&& motion) {
  std::vector<double> speeds;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double elapsed = seconds(poses[i].time - poses[i - 1].time);
    speeds.push_back(motion(poses[i - 1].T_local_body, poses[i].T_local_body).norm() / elapsed);
  }
  return median_of(std::move(speeds));
}

/// InputError if the poses move faster than any vehicle.
/// @param poses  T_world_body
void require_vehicle_speed(const std::vector<StampedPose>& poses, const fs::path& file) {
  constexpr double kFastest = 150;  // m/s
  const double speed = median_speed(poses, [](const RigidMotion& a, const RigidMotion& b) {
    return Eigen::Vector3d(b.translation() - a.translation());
  });
  if (speed <= kFastest) return;
  const double inverted = median_speed(poses, [](const RigidMotion& a, const RigidMotion& b) {
    return Eigen::Vector3d(b.inverse().translation() - a.inverse().translation());
  });
  throw InputError(fmt::format("the poses move at {:.0f} m/s: likely {}", speed,
                               inverted <= kFastest ? "T_body_world, not T_world_body"
                                                    : "another unit than meters"),
                   file.string(), "give T_world_body in meters, and times in nanoseconds");
}

GenericNavigation convert_poses(CsvRows rows, const fs::path& file, const DriveDescription& drive,
                                const LocalFrame& frame) {
  using namespace pose_column;
  GenericNavigation result;
  LeftOut left_out(file, rows);
  left_out.add_out_of_order(rows.drop_out_of_order());
  std::vector<StampedPose> poses;
  const Eigen::Vector3d middle = median_position(rows);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Eigen::Vector3d position(rows.at(row, kX), rows.at(row, kY), rows.at(row, kZ));
    const auto q = quaternion_of(rows, row, kQx);
    // The largest of numbers and a NaN may be a number.
    if (!q || !position.allFinite() || position.cwiseAbs().maxCoeff() > kMaxWorldCoordinate ||
        !is_possible_position(position - middle)) {
      left_out.add(rows.lines[row], "without a pose");
      continue;
    }
    RigidMotion T_world_body(*q);
    T_world_body.pretranslate(position);
    poses.push_back({rows.times[row], T_world_body, velocity_of(rows, row, kVelocity)});
    result.accuracy.push_back(accuracy_of(rows, row, kAccuracy));
  }
  left_out.warn(result);
  if (poses.empty()) {
    result.warn(file.string() + " has no pose that can be used: no navigation");
    return result;
  }
  require_vehicle_speed(poses, file);
  for (StampedPose& pose : poses) {
    pose.T_local_body = pose.T_local_body * drive.T_body_lidar;
    if (pose.velocity) pose.velocity = twist_of_part(*pose.velocity, drive.T_body_lidar);
  }
  result.frame = frame;
  if (!frame.world) {
    const Trajectory T_world_lidar(poses);
    result.frame.world =
        T_world_lidar.at(frame.time).value_or(poses.front().T_local_body).translation();
  }
  for (StampedPose& pose : poses) pose.T_local_body.pretranslate(-*result.frame.world);
  result.T_local_lidar.emplace(std::move(poses));
  return result;
}

}  // namespace

NavigationTables read_navigation_tables(const fs::path& folder,
                                        const std::optional<ScanPeriod>& scans) {
  NavigationTables tables;
  const auto read = [&](const char* name, std::span<const CsvColumn> columns) {
    std::optional<CsvRows> rows;
    if (fs::exists(folder / name)) {
      rows = read_timed_csv(folder / name, columns, scans, tables.notes);
    }
    return rows;
  };
  tables.poses = read("poses.csv", kPoseColumns);
  if (tables.poses) return tables;
  tables.positions = read("gnss.csv", kPositionColumns);
  if (tables.positions) tables.orientations = read("imu.csv", kOrientationColumns);
  return tables;
}

GenericNavigation convert_navigation(NavigationTables tables, const fs::path& folder,
                                     const DriveDescription& drive, const LocalFrame& frame) {
  if (tables.poses) {
    return convert_poses(std::move(*tables.poses), folder / "poses.csv", drive, frame);
  }
  if (tables.positions) return convert_positions(std::move(tables), folder, drive, frame);
  GenericNavigation none;
  none.notes.push_back("the drive has neither poses.csv nor gnss.csv: no navigation");
  return none;
}

GenericNavigation read_generic_navigation(const fs::path& folder, const DriveDescription& drive,
                                          TimeNs origin_time,
                                          const std::optional<ScanPeriod>& scans) {
  NavigationTables tables = read_navigation_tables(folder, scans);
  GenericNavigation navigation;
  navigation.append(tables);
  GenericNavigation converted = convert_navigation(std::move(tables), folder, drive, {origin_time});
  navigation.append(converted);
  static_cast<Messages&>(converted) = std::move(static_cast<Messages&>(navigation));
  return converted;
}

}  // namespace fovea
