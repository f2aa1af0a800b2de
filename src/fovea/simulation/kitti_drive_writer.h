// Writes a simulated drive as KITTI's files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fovea/core/output_folder.h"
#include "fovea/simulation/simulation_writer.h"

namespace fovea {

/// Everything is written below ROOT.partial, which becomes ROOT when finish() is called; what was
/// not finished is removed.
class KittiDriveWriter : public SimulationWriter {
 public:
  /// OutputError as OutputFolder's where anything exists at ROOT.
  explicit KittiDriveWriter(const std::filesystem::path& root);

  void write_scan(int frame, const SimulatedScan& scan) override;
  void write_further_scan(std::size_t lidar, int frame, const SimulatedScan& scan) override;
  void write_image(int camera, int number, TimeNs stamp, const Image& image) override;
  void write_texts(const Rig& rig, const std::vector<NavigationRecord>& records,
                   const SimulationOptions& options) override;
  std::filesystem::path truth_folder() const override;
  void write_file(const std::filesystem::path& name, std::string_view bytes) override;
  std::filesystem::path finish() override;

 private:
  std::filesystem::path root_;
  OutputFolder folder_;
};

}  // namespace fovea
