// Writes a simulated drive as a folder with a drive.toml (docs/drives.md).
#pragma once

#include "fovea/drive/writers/generic_drive_writer.h"
#include "fovea/simulation/simulation_writer.h"

namespace fovea {

/// Cameras are called camera_K, several LiDARs lidar_1, lidar_2, .... Everything is written below
/// ROOT.partial, as GenericDriveWriter does.
class GenericSimulationWriter : public SimulationWriter {
 public:
  /// OutputError as GenericDriveWriter.
  GenericSimulationWriter(const SimulationOptions& options, const std::filesystem::path& root);

  void write_scan(int frame, const SimulatedScan& scan) override;
  void write_further_scan(std::size_t lidar, int frame, const SimulatedScan& scan) override;
  void write_image(int camera, int number, TimeNs stamp, const Image& image) override;
  void write_exposure(int camera, int number, double exposure) override;
  void write_texts(const Rig& rig, const std::vector<NavigationRecord>& records,
                   const SimulationOptions& options) override;
  void write_imu(const std::vector<ImuRecord>& records) override;
  void write_wheels(const std::vector<WheelRecord>& records) override;
  std::filesystem::path truth_folder() const override { return writer_.truth_folder(); }
  void write_file(const std::filesystem::path& name, std::string_view bytes) override;
  std::filesystem::path finish() override;

 private:
  SimulationOptions options_;
  std::filesystem::path root_;
  GenericDriveWriter writer_;
  RecordedDrive drive_;
};

}  // namespace fovea
