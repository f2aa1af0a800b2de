// Writes a simulated drive as KITTI's files, with its truth beside them (docs/simulator.md).
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "fovea/base/image.h"
#include "fovea/simulation/truth_point.h"

namespace fovea {

/// Everything is written below ROOT.partial, which becomes ROOT when finish() is called; what was
/// not finished is removed. OutputError where anything exists at ROOT, its parent does not, or the
/// disk is full. Files of different frames and cameras may be written at once, from several
/// threads.
class DriveWriter {
 public:
  explicit DriveWriter(const std::filesystem::path& root);
  ~DriveWriter();
  DriveWriter(const DriveWriter&) = delete;
  DriveWriter& operator=(const DriveWriter&) = delete;

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

  /// Gives ROOT its name. Returns the drive's folder.
  std::filesystem::path finish();

 private:
  std::filesystem::path root_, partial_;
  bool finished_ = false;
};

}  // namespace fovea
