// What a drive is: frames (a LiDAR scan and the images taken with it), calibration, navigation.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fovea/camera.h"
#include "fovea/core/messages.h"
#include "fovea/drive.h"
#include "fovea/drive/motion_data.h"
#include "fovea/drive/scans/dropped_points.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/geometry/imu_data.h"
#include "fovea/geometry/sensor_profile.h"
#include "fovea/image.h"
#include "fovea/point_cloud.h"
#include "fovea/time.h"
#include "fovea/trajectory.h"

namespace fovea {

enum class SkipReason {
  kMissingScan,
  kDamagedScan,
  kMissingImage,
  kDamagedImage,
  kMissingStamp,
};
const char* to_string(SkipReason reason);

/// An image that a camera of the calibration should have taken and that cannot be used.
struct MissingImage {
  int camera = 0;  ///< the drive's number for it
  SkipReason reason = SkipReason::kMissingImage;
  std::string detail;  ///< one line: what and which file
};

/// A scan of a further LiDAR that a frame lacks.
struct MissingScan {
  std::string lidar;  ///< its name
  SkipReason reason = SkipReason::kMissingScan;
  std::string detail;  ///< one line: what and which file
};

/// One LiDAR sweep with the images that belong to it.
struct Frame {
  int index = 0;     ///< the number in the file's name
  TimeNs stamp = 0;  ///< scan time; see camera_of() for the images
  /// Lidar frame, as measured, with intensity. Of several LiDARs with the columns sensor and time.
  PointCloud scan;
  DroppedPoints dropped_points;  ///< not in `scan`
  /// One a camera of the calibration, in its order; empty where the camera has none that can be
  /// used, which at most all but one are.
  std::vector<Image> images;
  /// As DriveInfo has them, of each camera; none: all are 0, or not stated.
  std::vector<double> image_offsets;
  std::vector<std::optional<double>> image_exposures;
  std::vector<MissingImage> missing_images;  ///< why images are empty, in the cameras' order
  std::vector<MissingScan> missing_scans;    ///< the frame is used without them
  /// Of a live drive: measured since the frame before. Other drives have it in DriveInfo.
  MotionData motion;
};

/// A frame that cannot be used, for want of a scan, a stamp or any image: counted and reported, and
/// the drive goes on.
struct SkippedFrame {
  int index = 0;
  SkipReason reason = SkipReason::kMissingScan;
  std::string detail;  ///< one line: what and which file
};

using LoadedFrame = std::variant<Frame, SkippedFrame>;

/// DriveInfo::kind of a drive whose frames come while it is mapped.
inline constexpr const char* kLiveDrive = "live";

/// What is known of a drive before any frame is read.
struct DriveInfo : Messages {
  std::filesystem::path path;
  std::string kind;  ///< "kitti-raw", "kitti-odometry", "generic" or "live"
  Calibration calibration;
  std::vector<int> unused_cameras;  ///< numbers of those that have images and were not chosen
  int begin = 0, end = 0;           ///< frame indices, half-open; some may turn out to be skipped
  /// The indices in [begin, end) that have a scan, an image or a time stamp, ascending; empty: all.
  std::vector<int> frames;
  SweepTiming sweep;               ///< of scans whose points have no times
  bool sweep_compensated = false;  ///< scans are motion compensated already (KITTI odometry)
  /// Whether the points of a LiDAR among several have the times of its sweeps, since its files have
  /// none.
  bool times_by_azimuth = false;
  bool has_time_stamps = true;  ///< false: counted as 10 Hz
  /// The LiDARs by number. Empty for a drive with one, until its profile is estimated
  /// (pipeline/drive_sensors.h); of several the profiles have name and sweep alone until then.
  std::vector<MountedLidar> lidars;
  /// Whether the stamps of images are capture times. False (KITTI): an image counts as taken at its
  /// scan's stamp, plus Camera::image_delay.
  bool image_stamps_are_capture_times = false;
  /// Where they are: seconds from Camera::image_delay, the camera's median, to the delay of a
  /// frame's own image. By camera of the calibration, then by frame index; absent: 0.
  std::vector<std::map<int, double>> image_offsets;
  /// Exposure time times amplification of the images, base-2 logarithms, where the drive states
  /// them. By camera of the calibration, then by frame index.
  std::vector<std::map<int, double>> image_exposures;
  /// Pixels that show no scene, by number of the camera.
  std::map<int, ImageMask> masks;
  /// T_local_lidar by GPS/INS, local = east-north-up at the first usable frame's LiDAR (or, with
  /// poses.csv, in the axes of its world); absent
  /// where the drive has no (usable) navigation.
  std::optional<Trajectory> navigation;
  /// Standard deviation of a coordinate (m) of each pose of `navigation` as the unit states it: 0
  /// where it says nothing, infinite where it sees no satellite.
  std::vector<double> navigation_accuracy;
  std::optional<GeodeticPoint> origin;  ///< of `local`; absent: the map is not georeferenced
  CoordinateReference coordinates;      ///< of `origin`
  std::optional<ImuData> imu;           ///< absent where the drive has no (usable) IMU
  std::optional<WheelData> wheels;
  /// Poses T_local_lidar that came with the drive as reference (KITTI odometry poses), a frame
  /// index each from 0; empty if none. Never used by the mapper.
  std::vector<RigidMotion> reference_poses;
  /// Seconds from Camera::image_delay to the delay of the camera's image of one frame.
  /// @param slot  place of the camera in the calibration
  double image_offset(std::size_t slot, int index) const;
  /// Exposure of the image of a camera in one frame; absent where the drive does not state it.
  /// @param camera  number of the camera
  std::optional<double> image_exposure(int camera, int index) const;
  /// nullptr: every pixel of the camera shows the scene.
  const ImageMask* mask(int camera) const;
  /// camera_of() of a frame that is not read.
  Camera camera_at(std::size_t slot, int index) const;
  /// The indices of all frames, ascending.
  std::vector<int> frame_indices() const;
  std::size_t frame_count() const;
  /// Whether any image is taken at another time than its scan's stamp.
  bool has_image_delays() const;
};

/// A camera with the delay of its own image of a frame. Camera::at_image() then moves the camera to
/// the place where it took that image.
/// @param slot  place of the camera in the calibration
Camera camera_of(const DriveInfo& drive, const Frame& frame, std::size_t slot);

/// Reads the frames of a drive. All methods may be called by several threads at the same time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual const DriveInfo& info() const = 0;
  /// Reads frame `index` of [info().begin, info().end). DriveLostError if the drive can no longer
  /// be read from there on.
  virtual LoadedFrame load(int index) const = 0;
  /// Asks the system to read the files of load(index) ahead. Does not wait.
  virtual void expect(int /*index*/) const {}
  /// Time of a frame without reading it; empty if it has none.
  virtual std::optional<TimeNs> stamp(int index) const = 0;
};

/// Opens a folder with a drive.toml (docs/drives.md) or a KITTI raw or odometry drive, recognised
/// from its contents, or the one raw drive in the folders DATE/DATE_drive_NNNN_sync below `path`,
/// as `fovea simulate` writes it. InputError if the folder is missing, is none of these, or holds
/// several drives, or its calibration cannot be used; ConfigError for a camera it has not and for
/// what drive.toml says wrongly.
std::unique_ptr<FrameSource> open_drive(const std::filesystem::path& path,
                                        const DriveOptions& options);

/// InputError if the drive has no camera.
/// @param purpose  what needs one: "recoloring"
void require_cameras(const DriveInfo& drive, std::string_view purpose);

}  // namespace fovea
