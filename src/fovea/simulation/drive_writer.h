// Writes a simulated drive as KITTI's files, with its truth beside them (docs/simulator.md).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fovea/base/image.h"
#include "fovea/simulation/navigation_model.h"
#include "fovea/simulation/truth_point.h"

namespace fovea {

/// Everything is written below ROOT.partial, which becomes ROOT when finish() is called; what was
/// not finished is removed. Every function throws OutputError where the disk is full or refuses.
/// Files of different frames and cameras may be written at once, from several threads.
class DriveWriter {
 public:
  /// OutputError where anything exists at ROOT, its parent does not, or another program is writing
  /// it. A ROOT.partial that a killed program left is removed first; any other is left alone:
  /// OutputError.
  explicit DriveWriter(const std::filesystem::path& root);
  ~DriveWriter();
  DriveWriter(const DriveWriter&) = delete;
  DriveWriter& operator=(const DriveWriter&) = delete;

  /// @param points  x, y, z (m, LiDAR), reflectance 0-1
  void write_scan(int frame, const std::vector<std::array<float, 4>>& points);
  void write_truth(int frame, const std::vector<TruthPoint>& points);
  void write_image(int camera, int frame, const Image& image);
  void write_perfect_image(int camera, int frame, const Image& image);
  /// @param depth  m, row by row; 0 for sky
  void write_depth(int camera, int frame, int width, int height, const std::vector<float>& depth);
  /// A text below the drive's folder ("oxts/timestamps.txt", "truth/truth.json") or, with
  /// `in_date`, below its date's ("calib_cam_to_cam.txt").
  void write_text(const std::string& name, const std::string& text, bool in_date = false);
  /// Folder of the truth, for what writes its files itself (write_world).
  std::filesystem::path truth_folder() const;

  /// Makes everything durable and gives ROOT its name. Returns the drive's folder.
  std::filesystem::path finish();

 private:
  /// @param name  below ROOT.partial
  void write_file(const std::filesystem::path& name, const void* data, std::size_t size);

  std::filesystem::path root_, partial_;
  int lock_ = -1;  // descriptor of the marker in partial_, locked while this writes
};

/// The calibration, all time stamps and the records of GPS/INS.
void write_drive_texts(const Rig& rig, const std::vector<NavigationRecord>& records,
                       const SimulationOptions& options, DriveWriter& writer);

/// OutputError if the disk on which `path` is to be made has less than `bytes` left.
void check_free_space(const std::filesystem::path& path, std::uintmax_t bytes);

}  // namespace fovea
