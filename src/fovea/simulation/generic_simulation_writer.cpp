#include "fovea/simulation/generic_simulation_writer.h"

#include <fmt/format.h>

#include "fovea/simulation/drive_texts.h"

namespace fovea {
namespace {

std::string camera_name(int number) { return fmt::format("camera_{}", number); }

/// Empty: the drive has one LiDAR.
std::string lidar_name(const SimulationOptions& options, std::size_t number) {
  return options.further_lidars.empty() ? "" : fmt::format("lidar_{}", number + 1);
}

PointCloud cloud_of(const SimulatedScan& scan, const LidarOptions& lidar) {
  PointCloud cloud;
  for (const auto& [x, y, z, intensity] : scan.points) {
    cloud.position.emplace_back(x, y, z);
    cloud.intensity.push_back(intensity);
  }
  if (lidar.point_times) {
    for (const TruthPoint& point : scan.truth) cloud.time.push_back(point.time);
  }
  return cloud;
}

std::optional<SweepTiming> stated_sweep(const LidarOptions& lidar) {
  if (lidar.point_times || has_kittis_sweep(lidar)) return std::nullopt;
  return sweep_timing_of(lidar);
}

}  // namespace

GenericSimulationWriter::GenericSimulationWriter(const SimulationOptions& options,
                                                 const std::filesystem::path& root)
    : options_(options), root_(root), writer_(root) {}

void GenericSimulationWriter::write_scan(int frame, const SimulatedScan& scan) {
  writer_.write_scan(frame, stamp_of(frame, options_), cloud_of(scan, options_.lidar),
                     ScanFile::kPcd, lidar_name(options_, 0));
}

void GenericSimulationWriter::write_further_scan(std::size_t lidar, int frame,
                                                 const SimulatedScan& scan) {
  const FurtherLidarOptions& further = options_.further_lidars.at(lidar);
  const TimeNs stamp = stamp_of(frame, options_) + from_seconds(further.stamp_offset);
  writer_.write_scan(frame, stamp, cloud_of(scan, further.lidar), ScanFile::kPcd,
                     lidar_name(options_, lidar + 1));
}

void GenericSimulationWriter::write_image(int camera, int number, TimeNs stamp,
                                          const Image& image) {
  writer_.write_image(camera_name(camera), number, stamp, image);
}

void GenericSimulationWriter::write_exposure(int camera, int number, double exposure) {
  constexpr double kUsual = 0.004;  // s
  writer_.set_exposure(camera_name(camera), number, kUsual * exposure);
}

void GenericSimulationWriter::write_texts(const Rig& rig,
                                          const std::vector<NavigationRecord>& records,
                                          const SimulationOptions&) {
  // The IMU is the body.
  drive_.T_body_lidar = rig.T_imu_lidar;
  if (options_.imu.rate > 0) drive_.T_lidar_imu = rig.T_lidar_imu_calibrated;
  drive_.lidar.name = lidar_name(options_, 0);
  drive_.lidar.sweep = stated_sweep(options_.lidar);
  for (std::size_t k = 0; k < options_.further_lidars.size(); ++k) {
    RecordedLidar& lidar = drive_.further_lidars.emplace_back();
    lidar.name = lidar_name(options_, k + 1);
    lidar.sweep = stated_sweep(options_.further_lidars[k].lidar);
    lidar.T_lidar_sensor = rig.T_lidar_further[k];
  }
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    const int number = rig.cameras[k].index;
    drive_.cameras.push_back(
        {camera_name(number), number, rig.optics[k], rig.T_cam_lidar_calibrated[k].inverse()});
  }
  for (const NavigationRecord& record : records) {
    drive_.positions.push_back({record.time, record.place, record.accuracy,
                                Eigen::Vector3d(record.roll, record.pitch, record.yaw),
                                record.velocity});
  }
}

void GenericSimulationWriter::write_imu(const std::vector<ImuRecord>& records) {
  for (const ImuRecord& record : records) {
    drive_.inertia.push_back({record.time, std::nullopt, record.rate, record.force});
  }
}

void GenericSimulationWriter::write_wheels(const std::vector<WheelRecord>& records) {
  for (const WheelRecord& record : records) drive_.wheels.push_back({record.time, record.speed});
}

void GenericSimulationWriter::write_file(const std::filesystem::path& name,
                                         std::string_view bytes) {
  writer_.write_file(name, bytes);
}

std::filesystem::path GenericSimulationWriter::finish() {
  writer_.finish(drive_);
  return root_;
}

}  // namespace fovea
