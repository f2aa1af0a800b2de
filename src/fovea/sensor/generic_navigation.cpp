#include "fovea/sensor/generic_navigation.h"

#include "fovea/sensor/gnss_table.h"
#include "fovea/sensor/navigation_table.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxWorldCoordinate = 1e8;  // m: any map projection's, earth-centred ones, too

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
      left_out.add(rows.lines[row], "without a pose");
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
