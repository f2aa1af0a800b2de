// Detects calibrations with which cameras see no point of any scan.
#pragma once

#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"

namespace fovea {

/// Checks scans until every camera sees a point, or for kMaxScans scans. Does not use images.
class ViewCheck {
 public:
  static constexpr int kMaxScans = 100;

  /// @param drive  must outlive the check
  explicit ViewCheck(const DriveInfo& drive);

  /// InputError if no camera sees a point in kMaxScans scans.
  void add(const PointCloud& scan_lidar);
  /// InputError if no camera has seen a point so far.
  void require_view() const;
  /// Whether a camera has seen a point, or the drive has no camera.
  bool passed() const;
  /// Counts frames of an earlier run, which passed the check.
  void skip();
  /// One note for each camera that has seen no point.
  std::vector<std::string> notes() const;

 private:
  const DriveInfo& drive_;
  std::vector<bool> sees_;  // by camera
  int scans_ = 0;
};

}  // namespace fovea
