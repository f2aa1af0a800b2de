// What a drive contains and how `fovea map` would use it, without mapping it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/image.h"

namespace fovea {

struct DriveCheck {
  /// A pause between two frames.
  struct Gap {
    int frame = 0;  ///< after it
    double seconds = 0;
  };
  struct CameraFigures {
    int number = 0, width = 0, height = 0;
    double focal_px = 0;
    double delay = 0;         ///< s, from a scan's stamp to its image, median
    std::size_t missing = 0;  ///< of the sampled frames
    bool has_exposures = false, has_mask = false;
  };

  std::size_t frames = 0;                  ///< of the drive
  std::optional<double> duration, period;  ///< s; period: median step of the stamps
  std::vector<Gap> gaps;                   ///< over a second and over three usual steps
  std::size_t without_stamp = 0;

  // Of the sampled frames.
  std::size_t sampled = 0;
  std::map<std::string, std::size_t> skipped;        ///< by reason
  std::map<std::string, std::size_t> missing_scans;  ///< by name of the LiDAR
  double points_per_scan = 0;                        ///< median
  double near_range = 0, far_range = 0;              ///< m: quantiles 0.05 and 0.95
  bool has_point_times = false, has_intensity = false;
  DroppedPoints dropped;
  std::size_t points = 0;

  std::vector<MountedLidar> lidars;
  std::vector<CameraFigures> cameras;
  std::size_t navigation_poses = 0;
  std::optional<double> navigation_accuracy;  ///< m, median of those that are stated

  std::vector<std::string> plan;  ///< what a map would be made of, and what is assumed
  /// What a user should look at before mapping, in addition to the warnings of DriveInfo.
  std::vector<std::string> oddities;
};

/// Reads up to `samples` frames at even steps over the drive. InputError if no frame can be used.
DriveCheck check_drive(const FrameSource& source, int samples);

/// A frame's image, darker, with the edges of objects in the scan as dots, red (3 m) to blue
/// (25 m). If the calibration is right, they lie on the edges of the image.
/// @param slot  place of the camera in the calibration
/// InputError if the frame has no image.
Image calibration_overlay(const FrameSource& source, int frame, std::size_t slot);

}  // namespace fovea
