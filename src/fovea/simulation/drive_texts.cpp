#include "fovea/simulation/drive_texts.h"

#include <fmt/format.h>

#include <chrono>
#include <map>

namespace fovea {
namespace {

constexpr const char* kCalibrationTime = "calib_time: 01-Jan-2026 09:00:00\n";

/// "KEY: numbers", row by row, with every digit that a double has.
template <class Matrix>
std::string line(const std::string& key, const Matrix& matrix) {
  std::string text = key + ":";
  for (int r = 0; r < matrix.rows(); ++r) {
    for (int c = 0; c < matrix.cols(); ++c) text += fmt::format(" {:.16e}", double(matrix(r, c)));
  }
  return text + "\n";
}

std::string motion_text(const RigidMotion& T) {
  return fmt::format("{}{}{}", kCalibrationTime, line("R", T.linear()), line("T", T.translation()));
}

/// A camera's lines. Its image needs no rectification but R_rect: no distortion, and K is P_rect's.
std::string camera_text(const Camera& camera, const Eigen::Vector3d& t,
                        const Eigen::Matrix3d& R_rect) {
  Eigen::Matrix3d K;
  K << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  Eigen::Matrix<double, 3, 4> P;
  P << K, K * t;
  const Eigen::Vector2d size(camera.width, camera.height);
  const Eigen::Matrix<double, 1, 5> no_distortion = Eigen::Matrix<double, 1, 5>::Zero();
  const std::string number = fmt::format("_{:02d}", camera.index);
  const std::string rectified = "_rect" + number;
  return line("S" + number, size) + line("K" + number, K) + line("D" + number, no_distortion) +
         line("R" + number, Eigen::Matrix3d::Identity()) +
         line("T" + number, Eigen::Vector3d(R_rect.transpose() * t)) + line("S" + rectified, size) +
         line("R" + rectified, R_rect) + line("P" + rectified, P);
}

}  // namespace

TimeNs stamp_of(int frame, const SimulationOptions& options) {
  using namespace std::chrono;
  constexpr sys_days kDay = year(2026) / January / 1;
  const sys_days day = kDay + days(options.scene == Scene::kTown ? options.pass : 0);
  const auto start = duration_cast<nanoseconds>((day + hours(12)).time_since_epoch());
  return start.count() + from_seconds(frame * options.lidar.period);
}

std::string date_time_text(TimeNs time) {
  using namespace std::chrono;
  const sys_time<nanoseconds> point{nanoseconds(time)};
  const auto day = floor<days>(point);
  const year_month_day date{day};
  const hh_mm_ss<nanoseconds> clock{point - day};
  return fmt::format("{:04d}-{:02d}-{:02d} {:02d}:{:02d}:{:02d}.{:09d}", int(date.year()),
                     unsigned(date.month()), unsigned(date.day()), clock.hours().count(),
                     clock.minutes().count(), clock.seconds().count(), clock.subseconds().count());
}

std::string stamps_text(const SimulationOptions& options, double sweeps) {
  const TimeNs shift = from_seconds(sweeps * options.lidar.period);
  std::string text;
  for (int frame = 0; frame < options.frames; ++frame) {
    text += date_time_text(stamp_of(frame, options) + shift) + "\n";
  }
  return text;
}

CalibrationTexts calibration_texts(const Rig& rig, const SimulationOptions& options) {
  std::map<int, std::string> cameras;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    cameras[rig.cameras[i].index] = camera_text(rig.cameras[i], rig.t[i], rig.R_rect);
  }
  SimulationOptions kitti = options;
  kitti.camera.cameras = {kitti_camera(0), kitti_camera(1), kitti_camera(2), kitti_camera(3)};
  const Rig all = make_rig(kitti);
  for (std::size_t i = 0; i < all.cameras.size(); ++i) {
    cameras.try_emplace(all.cameras[i].index, camera_text(all.cameras[i], all.t[i], all.R_rect));
  }
  CalibrationTexts texts;
  texts.cam_to_cam = fmt::format("{}corner_dist: 9.950000e-02\n", kCalibrationTime);
  for (const auto& [number, text] : cameras) texts.cam_to_cam += text;
  texts.velo_to_cam = motion_text(rig.T_cam0_lidar);
  texts.imu_to_velo = motion_text(rig.T_imu_lidar.inverse());
  return texts;
}

}  // namespace fovea
