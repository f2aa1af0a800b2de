// A drive whose frames lie in numbered files; what its forms have in common.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "fovea/core/read_file.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/images/image_rectifier.h"
#include "fovea/drive/kitti/kitti_calibration.h"
#include "fovea/drive/scans/scan_format.h"
#include "fovea/drive/time_stamps.h"

namespace fovea {

/// The scans of a further LiDAR.
struct FurtherLidar {
  std::string name;
  RigidMotion T_lidar_sensor = RigidMotion::Identity();
  NumberedFiles scans;           ///< by frame
  std::map<int, TimeNs> stamps;  ///< by frame; absent: that of the frame
  ScanFormat format;
  SweepTiming sweep;       ///< of scans whose points have no times
  bool has_times = false;  ///< whether the points in the files have times
  bool sweep_compensated = false;
};

/// Where a drive's parts lie and which of them are usable.
struct DriveFiles {
  NumberedFiles scans;
  std::vector<NumberedFiles> images;  ///< one a camera of info.calibration, in its order
  TimeStamps stamps;                  ///< unused where !info.has_time_stamps
  bool stamps_name_scans = false;     ///< their file has numbers of scans; else a line a scan
  ScanFormat scan_format;
  std::vector<FurtherLidar> further_lidars;
  bool first_lidar_compensated = false;  ///< where there are further ones
  /// One a camera, empty where its images are rectified already; or none at all.
  std::vector<std::optional<ImageRectifier>> rectifiers;
};

/// Of a drive that has scans only.
inline constexpr const char* kNoCameraNote =
    "the drive has no camera: its scans are used alone, and a map has no colors";

/// Scan time of a frame; empty if the drive has stamps and this one is missing, malformed or out of
/// order. A drive without stamps counts as 10 Hz.
std::optional<TimeNs> frame_stamp(const DriveInfo& info, const TimeStamps& stamps, int index);

/// First frame of the range that has a scan, an image and a stamp, as far as can be known
/// without reading them; empty if there is none.
std::optional<int> first_usable_frame(const DriveInfo& info, const DriveFiles& files);

struct ScansReached {
  std::size_t stamped = 0;  ///< scans of the range that have a stamp
  std::size_t reached = 0;  ///< those of them at whose stamp the trajectory has a pose
};
ScansReached scans_reached(const Trajectory& T_local_lidar, const DriveInfo& info,
                           const DriveFiles& files);

/// The frames [first, last] of the scans, cut to the range asked for. ConfigError if nothing is
/// left.
std::pair<int, int> frame_range(const NumberedFiles& scans, const DriveOptions& options,
                                const std::filesystem::path& drive);

/// The cameras to use: those asked for, or camera 2, or else 3, 0, 1, whichever is there first, or
/// else the first.
/// ConfigError for one that is not there or is asked for twice; InputError if the drive has none.
/// @param present  cameras that have both a calibration and a folder of images
std::vector<int> choose_cameras(const std::vector<int>& present, const DriveOptions& options,
                                const std::filesystem::path& drive);

/// The cameras of `present` that are not among `chosen`.
std::vector<int> unused_cameras(const std::vector<int>& present, const std::vector<int>& chosen);

/// Fills `files.images`, info.calibration.cameras with the chosen cameras. A drive without any
/// folder of images has no camera, which a note says.
/// @param folder_prefix  "image_0" or "image_", before the camera's number
/// @param subfolder      "data" or ""
void find_images(const KittiCalibration& calibration, const DriveOptions& options,
                 const std::string& folder_prefix, const std::string& subfolder, DriveInfo& info,
                 DriveFiles& files);

/// Reads the mask of a camera. InputError if it cannot be read, ConfigError if it is not of the
/// size of the camera's images.
/// @param rectifier  of the images; nullptr: they are rectified
ImageMask read_mask(const std::filesystem::path& file, const Camera& camera,
                    const ImageRectifier* rectifier);
/// ConfigError for a mask of a camera that is not used.
void require_cameras_of_masks(const DriveOptions& options, const DriveInfo& info);

/// Reads the time stamps and the sweep's period into `info` and `files`, with notes of what is
/// missing.
/// @param read  read_date_times or read_seconds
void find_stamps(const std::filesystem::path& file,
                 TimeStamps (*read)(const std::filesystem::path&), DriveInfo& info,
                 DriveFiles& files);

/// Whether a step between stamps can be the period of a sweep, s.
bool can_be_sweep_period(double step);

/// Takes the sweep's period from the stamps into `info`. Returns false if they have no step, or,
/// with a note, if it cannot be a period. InputError for steps below 1 ms.
bool find_sweep_period(const std::filesystem::path& file, const TimeStamps& stamps,
                       DriveInfo& info);

std::unique_ptr<FrameSource> make_frame_source(DriveInfo info, DriveFiles files);

}  // namespace fovea
