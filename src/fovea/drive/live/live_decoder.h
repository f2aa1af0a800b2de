// Decodes the frames of a live drive.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/drive/images/image_rectifier.h"
#include "fovea/drive/live/raw_frame.h"
#include "fovea/drive/scans/scan_format.h"

namespace fovea {

/// How the scans of a LiDAR are read.
struct LiveLidar {
  std::string name;
  ScanFormat format;
  SweepTiming sweep;  ///< of scans whose points have no times
  bool sweep_compensated = false;
  double sweep_middle = 0;  ///< s from the stamp
  bool has_times = false;   ///< whether the points of its scans have times
  RigidMotion T_lidar_sensor = RigidMotion::Identity();
};

struct LiveCamera {
  std::string name;
  Camera camera;                            ///< with its usual delay
  std::optional<ImageRectifier> rectifier;  ///< absent: images need none
  double usual_delay = 0;                   ///< s from a scan's stamp to that of its image
};

/// What does not change after the beginning.
struct LiveDecoder {
  std::filesystem::path name;  ///< of the drive, for messages
  LiveLidar lidar;
  std::vector<LiveLidar> further_lidars;
  std::vector<LiveCamera> cameras;

  /// As FrameSource::load().
  LoadedFrame decode(const RawFrame& raw) const;
  /// From the usual delay of the camera to that of an image.
  double image_offset(std::size_t camera, const RawFrame& raw) const;
  /// See DriveInfo::image_exposures.
  static std::optional<double> image_exposure(std::size_t camera, const RawFrame& raw);

 private:
  std::string name_of(const LiveLidar& of, TimeNs stamp) const;
  void add_further_scans(const RawFrame& raw, Frame& frame) const;
  void add_images(const RawFrame& raw, Frame& frame) const;
  std::optional<MissingImage> load(std::size_t camera, const RawFrame& raw, Image& image) const;
};

/// The pixels of an image. InputError if it cannot be decoded.
Image pixels_of(const LiveImage& image, const std::string& name);

}  // namespace fovea
