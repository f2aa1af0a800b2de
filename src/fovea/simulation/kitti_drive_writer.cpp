#include "fovea/simulation/kitti_drive_writer.h"

#include <fmt/format.h>

#include <bit>
#include <stdexcept>

#include "fovea/drive/writers/png_encode.h"
#include "fovea/simulation/drive_texts.h"

namespace fovea {
namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "KITTI's files are little endian");

namespace {

constexpr const char* kDate = "2026_01_01";
constexpr const char* kDrive = "2026_01_01_drive_0001_sync";

fs::path drive_folder(const fs::path& root) { return root / kDate / kDrive; }

std::string image_folder(int camera) { return fmt::format("image_{:02d}", camera); }

}  // namespace

KittiDriveWriter::KittiDriveWriter(const fs::path& root)
    : root_(root), folder_(root, false, {kDate}) {}

void KittiDriveWriter::write_scan(int frame, const SimulatedScan& scan) {
  write_file(fs::path("velodyne_points/data") / numbered(frame, ".bin"),
             {reinterpret_cast<const char*>(scan.points.data()),
              scan.points.size() * sizeof(scan.points[0])});
}

void KittiDriveWriter::write_further_scan(std::size_t, int, const SimulatedScan&) {
  throw std::logic_error("KITTI's format has a place for one LiDAR");
}

void KittiDriveWriter::write_image(int camera, int number, TimeNs /*stamp*/, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  write_file(fs::path(image_folder(camera)) / "data" / numbered(number, ".png"),
             {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

fs::path KittiDriveWriter::truth_folder() const {
  return drive_folder(folder_.partial()) / "truth";
}

fs::path KittiDriveWriter::finish() {
  folder_.commit();
  return drive_folder(root_);
}

void KittiDriveWriter::write_file(const fs::path& name, std::string_view bytes) {
  folder_.write(drive_folder("") / name, bytes);
}

void KittiDriveWriter::write_texts(const Rig& rig, const std::vector<NavigationRecord>& records,
                                   const SimulationOptions& options) {
  const CalibrationTexts calibration = calibration_texts(rig, options);
  folder_.write(fs::path(kDate) / "calib_cam_to_cam.txt", calibration.cam_to_cam);
  folder_.write(fs::path(kDate) / "calib_velo_to_cam.txt", calibration.velo_to_cam);
  folder_.write(fs::path(kDate) / "calib_imu_to_velo.txt", calibration.imu_to_velo);

  write_file("velodyne_points/timestamps.txt", stamps_text(options));
  write_file("velodyne_points/timestamps_start.txt", stamps_text(options, -0.5));
  write_file("velodyne_points/timestamps_end.txt", stamps_text(options, 0.5));
  for (const Camera& camera : rig.cameras) {
    write_file(image_folder(camera.index) + "/timestamps.txt", stamps_text(options));
  }
  std::string stamps;
  for (std::size_t i = 0; i < records.size(); ++i) {
    stamps += date_time_text(records[i].time) + "\n";
    write_file("oxts/data/" + numbered(static_cast<int>(i), ".txt"), records[i].text);
  }
  write_file("oxts/timestamps.txt", stamps);
  write_file("oxts/dataformat.txt", navigation_format_text());
}

}  // namespace fovea
