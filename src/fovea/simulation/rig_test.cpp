#include "fovea/simulation/rig.h"

#include <gtest/gtest.h>

#include "fovea/core/angle.h"

namespace fovea::rig_test {

SimulationOptions mounted(double roll, double pitch, double yaw) {
  SimulationOptions options;
  options.lidar.roll = roll * kDegree;
  options.lidar.pitch = pitch * kDegree;
  options.lidar.yaw = yaw * kDegree;
  return options;
}

TEST(Rig, AMountTurnsTheLidarAlone) {
  const Rig plain = make_rig({});
  for (const SimulationOptions& options :
       {mounted(180, 0, 0), mounted(0, 30, 0), mounted(0, 0, -75), mounted(10, -20, 130)}) {
    const Rig rig = make_rig(options);
    EXPECT_TRUE(rig.T_vehicle_lidar.translation().isApprox(plain.T_vehicle_lidar.translation()));
    const RigidMotion T_vehicle_imu = rig.T_vehicle_lidar * rig.T_imu_lidar.inverse();
    EXPECT_TRUE(T_vehicle_imu.isApprox(plain.T_vehicle_lidar * plain.T_imu_lidar.inverse(), 1e-12));
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      const RigidMotion T_vehicle_cam = rig.T_vehicle_lidar * rig.cameras[k].T_cam_lidar.inverse();
      EXPECT_TRUE(T_vehicle_cam.isApprox(
          plain.T_vehicle_lidar * plain.cameras[k].T_cam_lidar.inverse(), 1e-12));
    }
  }
}

TEST(Rig, AMountsAnglesAreRollPitchYaw) {
  const Eigen::Matrix3d R_upright = make_rig({}).T_vehicle_lidar.linear();
  const auto turned = [&](const SimulationOptions& options) -> Eigen::Matrix3d {
    return R_upright.transpose() * make_rig(options).T_vehicle_lidar.linear();
  };
  using Eigen::Vector3d;
  // Its y axis points down, its z axis to the left.
  EXPECT_TRUE((turned(mounted(-90, 0, 0)) * Vector3d::UnitY()).isApprox(-Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE((turned(mounted(-90, 0, 0)) * Vector3d::UnitZ()).isApprox(Vector3d::UnitY(), 1e-12));
  // Its x axis points down, or to the left.
  EXPECT_TRUE((turned(mounted(0, 90, 0)) * Vector3d::UnitX()).isApprox(-Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE((turned(mounted(0, 0, 90)) * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-12));
  // Roll is about the axis that pitch and yaw have turned.
  EXPECT_TRUE((turned(mounted(90, 0, 90)) * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE((turned(mounted(90, 0, 90)) * Vector3d::UnitY()).isApprox(Vector3d::UnitZ(), 1e-12));
}

}  // namespace fovea::rig_test
