// Upsampling of a real scan: how many points each rate gives.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "../../../tests/kitti_sample.h"
#include "fovea/upsample.h"

namespace fovea::upsample_kitti_test {

// Minimal readers of KITTI's files, since this folder may not use the reader in sensor/.
Eigen::MatrixXd calibration(const std::filesystem::path& file, const std::string& key, int rows,
                            int columns) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(key + ":")) continue;
    std::istringstream numbers(line.substr(key.size() + 1));
    Eigen::MatrixXd matrix(rows, columns);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) numbers >> matrix(r, c);
    }
    return matrix;
  }
  ADD_FAILURE() << "no " << key << " in " << file;
  return Eigen::MatrixXd::Zero(rows, columns);
}

Camera camera_2(const std::filesystem::path& folder) {
  const auto cam_to_cam = folder / "calib_cam_to_cam.txt", velo = folder / "calib_velo_to_cam.txt";
  const Eigen::MatrixXd P = calibration(cam_to_cam, "P_rect_02", 3, 4);
  RigidMotion T_cam0_lidar = RigidMotion::Identity(), R_rect = RigidMotion::Identity();
  T_cam0_lidar.linear() = calibration(velo, "R", 3, 3);
  T_cam0_lidar.translation() = calibration(velo, "T", 3, 1);
  R_rect.linear() = calibration(cam_to_cam, "R_rect_00", 3, 3);
  Camera camera{.index = 2, .width = 1242, .height = 375};
  camera.fx = P(0, 0), camera.fy = P(1, 1), camera.cx = P(0, 2), camera.cy = P(1, 2);
  const Eigen::Vector3d baseline = P.leftCols<3>().inverse() * P.col(3);
  camera.T_cam_lidar = Eigen::Translation3d(baseline) * R_rect * T_cam0_lidar;
  return camera;
}

// Points of a raw scan that the camera sees, camera frame, their LiDAR ranges within [near, far).
PointCloud scan_in_view(const std::filesystem::path& file, const Camera& camera, float near,
                        float far) {
  std::ifstream stream(file, std::ios::binary);
  PointCloud cloud;
  for (std::array<float, 4> xyzr; stream.read(reinterpret_cast<char*>(xyzr.data()), sizeof xyzr);) {
    const Eigen::Vector3f p_lidar(xyzr[0], xyzr[1], xyzr[2]);
    if (p_lidar.norm() < near || p_lidar.norm() >= far) continue;
    const Eigen::Vector3d p_cam = camera.T_cam_lidar * p_lidar.cast<double>();
    const auto pixel = camera.project(p_cam);
    if (!pixel || pixel->x() < 0 || pixel->x() >= camera.width || pixel->y() < 0 ||
        pixel->y() >= camera.height) {
      continue;
    }
    cloud.position.push_back(p_cam.cast<float>());
    cloud.range.push_back(p_lidar.norm());
  }
  return cloud;
}

void expect_counts(const PointCloud& cloud, const Camera& camera,
                   const std::array<double, 4>& counts) {
  for (int rate = 0; rate < 4; ++rate) {
    const PointCloud dense = upsample(cloud, camera, {.rate = rate, .max_edge = 0.3});
    const auto size = static_cast<double>(dense.size());
    EXPECT_NEAR(size, counts[rate], 0.03 * counts[rate]) << "rate " << rate;
    EXPECT_NO_THROW(dense.check());
    const auto interpolated = std::count(dense.interpolated.begin(), dense.interpolated.end(), 1);
    EXPECT_EQ(static_cast<std::size_t>(interpolated), dense.size() - cloud.size());
    for (std::size_t i = 0; i < dense.size(); ++i) {
      ASSERT_LE(dense.normal[i].dot(dense.position[i]), 0) << "normal away from the camera " << i;
    }
  }
}

TEST(UpsampleKitti, CountsOfARealScan) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const Camera camera = camera_2(drive.parent_path());
  const auto scan = drive / "velodyne_points/data/0000000030.bin";
  const PointCloud all = scan_in_view(scan, camera, 0, std::numeric_limits<float>::infinity());
  expect_counts(all, camera, {19329, 31788, 68777, 178660});
  const PointCloud white_zone = scan_in_view(scan, camera, 3, 15);
  expect_counts(white_zone, camera, {10421, 19061, 45115, 122849});
}

}  // namespace fovea::upsample_kitti_test
