#include "fovea/simulation/generic_simulation_writer.h"

#include <fmt/format.h>

#include "fovea/simulation/drive_texts.h"

namespace fovea {
namespace {

std::string camera_name(int number) { return fmt::format("camera_{}", number); }

}  // namespace

GenericSimulationWriter::GenericSimulationWriter(const SimulationOptions& options,
                                                 const std::filesystem::path& root)
    : options_(options), root_(root), writer_(root) {}

void GenericSimulationWriter::write_scan(int frame, const SimulatedScan& scan) {
  PointCloud cloud;
  for (const auto& [x, y, z, intensity] : scan.points) {
    cloud.position.emplace_back(x, y, z);
    cloud.intensity.push_back(intensity);
  }
  if (options_.lidar.point_times) {
    for (const TruthPoint& point : scan.truth) cloud.time.push_back(point.time);
  }
  writer_.write_scan(frame, stamp_of(frame, options_), cloud);
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
  const LidarOptions& lidar = options_.lidar;
  if (!lidar.point_times && !has_kittis_sweep(lidar)) drive_.sweep = sweep_timing_of(lidar);
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

void GenericSimulationWriter::write_file(const std::filesystem::path& name,
                                         std::string_view bytes) {
  writer_.write_file(name, bytes);
}

std::filesystem::path GenericSimulationWriter::finish() {
  writer_.finish(drive_);
  return root_;
}

}  // namespace fovea
