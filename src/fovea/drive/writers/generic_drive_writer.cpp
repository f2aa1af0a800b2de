#include "fovea/drive/writers/generic_drive_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <fstream>
#include <stdexcept>

#include "fovea/core/angle.h"
#include "fovea/core/output_file.h"
#include "fovea/core/plain_name.h"
#include "fovea/drive/writers/motion_tables.h"
#include "fovea/drive/writers/png_encode.h"

namespace fovea {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD's binary data is little endian");

std::string file_name(int number, std::string_view extension) {
  return fmt::format("{:06d}{}", number, extension);
}

std::string pcd_text(const PointCloud& scan) {
  const bool has_times = !scan.time.empty(), has_rings = !scan.ring.empty();
  const auto columns = [&](const char* real, const char* ring) {
    return fmt::format("{0} {0} {0} {0}{1}{2}", real, has_times ? fmt::format(" {}", real) : "",
                       has_rings ? fmt::format(" {}", ring) : "");
  };
  std::string bytes = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity{}{}\nSIZE "
      "{}\n"
      "TYPE {}\nCOUNT {}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      has_times ? " time" : "", has_rings ? " ring" : "", columns("4", "2"), columns("F", "U"),
      columns("1", "1"), scan.size(), scan.size());
  const auto put = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (std::size_t i = 0; i < scan.size(); ++i) {
    for (const float coordinate : scan.position[i]) put(coordinate);
    put(scan.intensity.empty() ? 0.0f : scan.intensity[i]);
    if (has_times) put(scan.time[i]);
    if (has_rings) put(scan.ring[i]);
  }
  return bytes;
}

std::string kitti_text(const PointCloud& scan) {
  if (!scan.time.empty()) throw std::invalid_argument("a KITTI scan has no place for times");
  std::string bytes;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f& p = scan.position[i];
    const std::array<float, 4> point{p.x(), p.y(), p.z(),
                                     scan.intensity.empty() ? 0 : scan.intensity[i]};
    bytes.append(reinterpret_cast<const char*>(point.data()), sizeof point);
  }
  return bytes;
}

constexpr const char* kStampsHeader = "index,time_ns\n";
constexpr const char* kExposuresHeader = "index,time_ns,exposure_s\n";

std::string stamp_rows(const std::map<int, TimeNs>& stamps) {
  std::string rows;
  for (const auto& [number, time] : stamps) rows += fmt::format("{},{}\n", number, time);
  return rows;
}

/// @param exposures  s
std::string exposure_rows(const std::map<int, TimeNs>& stamps,
                          const std::map<int, double>& exposures) {
  std::string rows;
  for (const auto& [number, time] : stamps) {
    const auto exposure = exposures.find(number);
    rows += exposure == exposures.end() ? fmt::format("{},{},\n", number, time)
                                        : fmt::format("{},{},{}\n", number, time, exposure->second);
  }
  return rows;
}

std::string motion_text(const QuaternionMotion& T) {
  const Eigen::Vector3d& t = T.translation;
  const Eigen::Quaterniond& q = T.rotation;
  return fmt::format("{{translation = [{}, {}, {}], rotation = [{}, {}, {}, {}]}}", t.x(), t.y(),
                     t.z(), q.x(), q.y(), q.z(), q.w());
}

std::string camera_text(const RecordedCamera& camera) {
  const LensCamera& c = camera.optics;
  std::string text = fmt::format(
      "\n[camera.{}]\nindex = {}\nwidth = {}\nheight = {}\nK = [{}, 0, {}, 0, {}, {}, 0, 0, 1]\n",
      camera.name, camera.index, c.width, c.height, c.fx, c.cx, c.fy, c.cy);
  const auto& k = c.lens.coefficients();
  const std::size_t count = coefficient_count(c.lens.model());
  text += fmt::format("distortion_model = \"{}\"\nD = [{}]\n", to_string(c.lens.model()),
                      fmt::join(k.begin(), k.begin() + std::ptrdiff_t(count), ", "));
  return text + fmt::format("T_lidar_cam = {}\n", motion_text(camera.T_lidar_cam));
}

std::string sweep_text(const SweepTiming& sweep) {
  const bool clockwise = sweep.direction == SweepDirection::kClockwise;
  return fmt::format(
      "sweep_period_s = {}\nrotation = \"{}\"\nsweep_start_deg = {}\nstamp_phase = {}\n",
      sweep.period, clockwise ? "clockwise" : "counterclockwise", sweep.start_azimuth / kDegree,
      sweep.stamp_phase);
}

/// @param has_pose  whether the LiDAR's frame is another one than `lidar`
std::string lidar_text(const RecordedLidar& lidar, bool has_pose) {
  const std::string table = lidar.name.empty() ? "lidar" : "lidar." + lidar.name;
  std::string text = fmt::format("\n[{}]\ncompensated = {}\nintensity_max = {}\n", table,
                                 lidar.sweep_compensated, lidar.intensity_max);
  if (lidar.sweep) text += sweep_text(*lidar.sweep);
  if (has_pose) text += fmt::format("T_lidar_sensor = {}\n", motion_text(lidar.T_lidar_sensor));
  return text;
}

/// A folder below the drive's: names of other characters could lead out of it.
std::filesystem::path sensor_folder(const char* kind, const std::string& name) {
  if (!is_plain_name(name)) {
    throw std::invalid_argument("a sensor's name is of letters, digits, '_' and '-'");
  }
  return std::filesystem::path(kind) / name;
}

std::filesystem::path image_folder(const std::string& camera) {
  return sensor_folder("images", camera);
}

std::filesystem::path scan_folder(const std::string& lidar) {
  return lidar.empty() ? "lidar" : sensor_folder("lidar", lidar);
}

}  // namespace

std::string drive_toml(const RecordedDrive& drive) {
  std::string text = "version = 1\n" + lidar_text(drive.lidar, /*has_pose=*/false);
  for (const RecordedLidar& lidar : drive.further_lidars) {
    text += lidar_text(lidar, /*has_pose=*/true);
  }
  const Eigen::Vector3d& antenna = drive.antenna_body;
  text += fmt::format("\n[body]\nT_body_lidar = {}\nT_body_imu = {}\nantenna = [{}, {}, {}]\n",
                      motion_text(drive.T_body_lidar), motion_text(drive.T_body_imu), antenna.x(),
                      antenna.y(), antenna.z());
  if (drive.T_lidar_imu) {
    text += fmt::format("\n[imu]\nT_lidar_imu = {}\n", motion_text(*drive.T_lidar_imu));
  }
  for (const RecordedCamera& camera : drive.cameras) text += camera_text(camera);
  return text;
}

GenericDriveWriter::GenericDriveWriter(const std::filesystem::path& root, bool force)
    : folder_(root, force,
              {"drive.toml", "lidar", "images", "poses.csv", "gnss.csv", "imu.csv", "wheels.csv",
               "truth", "depth", "tracklet_labels.xml"}) {}

void GenericDriveWriter::write_scan(int number, TimeNs stamp, const PointCloud& scan_sensor,
                                    ScanFile format, const std::string& lidar) {
  const bool pcd = format == ScanFile::kPcd;
  folder_.write(scan_folder(lidar) / file_name(number, pcd ? ".pcd" : ".bin"),
                pcd ? pcd_text(scan_sensor) : kitti_text(scan_sensor));
  const std::lock_guard lock(mutex_);
  scan_stamps_[lidar][number] = stamp;
}

void GenericDriveWriter::write_image(const std::string& camera, int number, TimeNs stamp,
                                     const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_encoded_image(camera, number, stamp,
                      {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, ".png");
}

void GenericDriveWriter::set_exposure(const std::string& camera, int number, double exposure) {
  const std::lock_guard lock(mutex_);
  exposures_[camera][number] = exposure;
}

void GenericDriveWriter::write_encoded_image(const std::string& camera, int number, TimeNs stamp,
                                             std::string_view bytes, const std::string& extension) {
  folder_.write(image_folder(camera) / file_name(number, extension), bytes);
  const std::lock_guard lock(mutex_);
  image_stamps_[camera][number] = stamp;
}

void GenericDriveWriter::write_file(const std::filesystem::path& name,
                                    std::string_view bytes) const {
  folder_.write(name, bytes);
}

void GenericDriveWriter::finish(const RecordedDrive& drive) {
  for (const auto& [name, text] : motion_tables(drive)) folder_.write(name, text);
  finish(std::string_view(drive_toml(drive)));
}

void GenericDriveWriter::append_rows(const std::filesystem::path& name, std::string_view header,
                                     std::string_view rows) const {
  const std::filesystem::path file = folder() / name;
  const bool is_new = !std::filesystem::exists(file);
  std::ofstream stream(file, std::ios::binary | std::ios::app);
  if (is_new) stream << header;
  stream << rows;
  stream.close();
  if (!stream) throw_output_error(file, errno);
}

void GenericDriveWriter::flush_stamps() {
  are_exposures_flushed_ = true;
  write_stamps();
}

void GenericDriveWriter::write_stamps() {
  const std::lock_guard lock(mutex_);
  for (auto& [lidar, stamps] : scan_stamps_) {
    append_rows(scan_folder(lidar) / "stamps.csv", kStampsHeader, stamp_rows(stamps));
    stamps.clear();
  }
  for (auto& [camera, stamps] : image_stamps_) {
    std::map<int, double>& exposures = exposures_[camera];
    const std::filesystem::path table = image_folder(camera) / "stamps.csv";
    if (exposures.empty() && !are_exposures_flushed_) {
      append_rows(table, kStampsHeader, stamp_rows(stamps));
    } else {
      append_rows(table, kExposuresHeader, exposure_rows(stamps, exposures));
    }
    stamps.clear();
    exposures.clear();
  }
}

void GenericDriveWriter::finish(std::string_view toml) {
  folder_.write("drive.toml", toml);
  write_stamps();
  folder_.commit();
}

}  // namespace fovea
