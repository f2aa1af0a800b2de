// Writes a synthetic drive as a KITTI raw drive: files that the product's own reader must read
// back.
#pragma once

#include <fmt/format.h>
#include <png.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "fovea/geometry/geodesy.h"
#include "tests/synthetic_drive.h"

namespace fovea {

inline std::string kitti_stem(int frame) { return fmt::format("{:010d}", frame); }

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

inline void write_png(const std::filesystem::path& file, const Image& image) {
  std::filesystem::create_directories(file.parent_path());
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png_uint_32(image.width);
  png.height = png_uint_32(image.height);
  png.format = image.channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
  if (png_image_write_to_file(&png, file.c_str(), 0, image.data.data(), 0, nullptr) == 0) {
    throw std::runtime_error("cannot write a PNG");
  }
}

/// One stamp line; frames are a tenth of a second apart.
inline std::string kitti_stamp(int frame) {
  return fmt::format("2011-09-26 13:02:{:02d}.{:09d}\n", 10 + frame / 10, frame % 10 * 100'000'000);
}

/// Writes the drive below `root` and returns its folder,
/// ROOT/2011_09_26/2011_09_26_drive_0001_sync. The IMU is where the LiDAR is, and every scan is
/// taken at rest (no sweep motion is written).
inline std::filesystem::path write_kitti_drive(const SyntheticDrive& drive,
                                               const std::filesystem::path& root) {
  const auto date = root / "2011_09_26";
  const auto folder = date / "2011_09_26_drive_0001_sync";
  const Camera& camera = drive.info().calibration.cameras.at(0);
  const auto numbers = [](const auto& matrix) {
    std::string text;
    for (int r = 0; r < matrix.rows(); ++r) {
      for (int c = 0; c < matrix.cols(); ++c) text += fmt::format(" {:.15e}", double(matrix(r, c)));
    }
    return text;
  };
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  std::string cameras = "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\n";
  for (int k = 0; k < 4; ++k) {
    cameras += fmt::format("S_rect_0{}: {} {}\n", k, camera.width, camera.height);
    cameras += fmt::format("R_rect_0{}:{}\n", k, numbers(identity));
    cameras += fmt::format("P_rect_0{}: {} 0 {} 0 0 {} {} 0 0 0 1 0\n", k, camera.fx, camera.cx,
                           camera.fy, camera.cy);
  }
  write_text(date / "calib_cam_to_cam.txt", cameras);
  write_text(date / "calib_velo_to_cam.txt",
             fmt::format("R:{}\nT:{}\n", numbers(camera.T_cam_lidar.linear()),
                         numbers(camera.T_cam_lidar.translation())));
  write_text(date / "calib_imu_to_velo.txt", fmt::format("R:{}\nT: 0 0 0\n", numbers(identity)));

  const LocalTangentPlane plane({49.01, 8.43, 114.5});
  std::string stamps;
  for (int i = drive.info().begin; i < drive.info().end; ++i) {
    const Frame frame = std::get<Frame>(drive.load(i));
    std::vector<float> scan;
    for (std::size_t p = 0; p < frame.scan.size(); ++p) {
      const Eigen::Vector3f& point = frame.scan.position[p];
      scan.insert(scan.end(), {point.x(), point.y(), point.z(), frame.scan.intensity[p]});
    }
    const auto scan_file = folder / "velodyne_points/data" / (kitti_stem(i) + ".bin");
    write_text(scan_file, std::string(reinterpret_cast<const char*>(scan.data()), scan.size() * 4));
    write_png(folder / "image_02/data" / (kitti_stem(i) + ".png"), frame.images[0]);

    const RigidMotion& T = drive.T_local_lidar[std::size_t(i)];
    const GeodeticPoint g = plane.to_geodetic(T.translation());
    const double yaw = std::atan2(T.linear()(1, 0), T.linear()(0, 0));
    write_text(
        folder / "oxts/data" / (kitti_stem(i) + ".txt"),
        fmt::format("{:.14f} {:.14f} {:.9f} 0 0 {:.15f} 0 0 8 0 0 0 0 9.8 0 0 9.8 0 0 0 0 0 0 "
                    "0.05 0.05 4 10 4 4 0\n",
                    g.latitude, g.longitude, g.altitude, yaw));
    stamps += kitti_stamp(i);
  }
  for (const char* part : {"velodyne_points", "image_02", "oxts"}) {
    write_text(folder / part / "timestamps.txt", stamps);
  }
  return folder;
}

}  // namespace fovea
