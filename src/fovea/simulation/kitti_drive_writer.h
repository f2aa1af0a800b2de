// Writes a simulated drive as KITTI's files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fovea/simulation/drive_writer.h"

namespace fovea {

/// Everything is written below ROOT.partial, which becomes ROOT when finish() is called; what was
/// not finished is removed.
class KittiDriveWriter : public DriveWriter {
 public:
  /// OutputError where anything exists at ROOT, its parent does not, or another program is writing
  /// it. A ROOT.partial that a killed program left is removed first; any other is left alone:
  /// OutputError.
  explicit KittiDriveWriter(const std::filesystem::path& root);
  ~KittiDriveWriter() override;
  KittiDriveWriter(const KittiDriveWriter&) = delete;
  KittiDriveWriter& operator=(const KittiDriveWriter&) = delete;

  void write_scan(int frame, const SimulatedScan& scan) override;
  void write_image(int camera, int frame, const Image& image) override;
  void write_texts(const Rig& rig, const std::vector<NavigationRecord>& records,
                   const SimulationOptions& options) override;
  std::filesystem::path truth_folder() const override;
  void write_file(const std::filesystem::path& name, std::string_view bytes) override;
  std::filesystem::path finish() override;

 private:
  /// @param name  below ROOT.partial
  void write_below_root(const std::filesystem::path& name, std::string_view bytes);

  std::filesystem::path root_, partial_;
  int lock_ = -1;  // descriptor of the marker in partial_, locked while this writes
};

}  // namespace fovea
