// Drives: reading one frame by frame, and writing one.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fovea/camera.h"
#include "fovea/image.h"
#include "fovea/point_cloud.h"
#include "fovea/sweep_motion.h"
#include "fovea/time.h"
#include "fovea/trajectory.h"

namespace fovea {

struct DriveOptions {
  /// Camera numbers in the order in which they take turns; empty: camera 2, or else the first
  /// color camera that the drive has, or else the first camera.
  std::vector<int> cameras = {};
  /// Half-open range of frame indices; an open end is the drive's own.
  std::optional<int> begin = {}, end = {};
  bool use_navigation = true;
  bool use_imu = true;  ///< angular rates, accelerations and wheel speeds
  /// Masks by number of the camera, in place of those that the drive has.
  std::map<int, std::filesystem::path> masks = {};
  /// False: scans alone are read; the calibration has no cameras, and the drive needs none.
  bool use_images = true;
};

/// A LiDAR sweep with its images. Copies share their data.
class FOVEA_API DriveFrame {
 public:
  int index() const;
  TimeNs stamp() const;
  /// LiDAR frame, as measured: not yet motion compensated. With intensity (0 to 1), and with time
  /// (s from the stamp) and ring if the drive has them.
  const PointCloud& scan() const;
  /// An image for each of Drive::cameras(); empty where it is missing.
  const std::vector<Image>& images() const;
  /// Why images are empty, a line each: "camera 2: missing image, FILE".
  std::vector<std::string> missing_images() const;
  /// Points of the scan that are not finite or out of reach, and not in scan().
  std::size_t points_dropped() const;

  struct Content;
  explicit DriveFrame(std::shared_ptr<const Content> content) : content_(std::move(content)) {}
  const Content& content() const { return *content_; }

 private:
  std::shared_ptr<const Content> content_;
};

/// Scans, images and navigation of a vehicle, from files (docs/drives.md).
///
///   const Drive drive("street");
///   for (const int index : drive.frames()) {
///     if (const auto frame = drive.try_load(index)) use(frame->scan(), frame->images());
///   }
///
/// All functions may be called by several threads at the same time. Copies share the drive.
class FOVEA_API Drive {
 public:
  /// Opens a folder with a drive.toml, or a KITTI raw or odometry drive.
  /// @throws InputError   if the folder is missing or damaged, or is no drive
  /// @throws ConfigError  for a camera that the drive does not have
  explicit Drive(const std::filesystem::path& folder, const DriveOptions& options = {});

  const std::filesystem::path& folder() const;
  /// "kitti-raw", "kitti-odometry" or "generic" (a folder with a drive.toml).
  const std::string& kind() const;
  /// Indices of the frames, ascending; some of them may turn out to be unusable.
  std::vector<int> frames() const;
  /// @throws InputError         if the frame lacks its scan, its stamp or all images
  /// @throws std::out_of_range  for an index outside the drive
  DriveFrame load(int index) const;
  /// The frame, or nothing if load() throws InputError.
  std::optional<DriveFrame> try_load(int index) const;

  /// The chosen cameras, without distortion; images are undistorted, too.
  const std::vector<Camera>& cameras() const;
  /// When the points of scans without times were measured.
  SweepTiming sweep() const;
  /// Whether scans are motion compensated already.
  bool is_compensated() const;
  /// T_local_lidar by GPS/INS or poses of the drive; absent if there are none.
  const std::optional<Trajectory>& navigation() const;
  /// From the LiDAR to the body whose poses the navigation system measures; absent if not known.
  const std::optional<RigidMotion>& T_body_lidar() const;
  /// What a user should know of the drive, a line each.
  const std::vector<std::string>& warnings() const;
  /// The warnings, and lines that only inform.
  const std::vector<std::string>& notes() const;

  struct Content;
  const std::shared_ptr<const Content>& content() const { return content_; }

 private:
  std::shared_ptr<const Content> content_;
};

/// A camera of a drive to be written.
struct DriveCamera {
  std::string name;  ///< letters, digits, '_' and '-'
  int number = 0;    ///< 0 to 9
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels; integers are centers of pixels
  /// "none", "plumb_bob", "rational_polynomial" or "equidistant", as in ROS.
  std::string distortion_model = "none";
  std::vector<double> distortion = {};  ///< coefficients, in the order of ROS
  RigidMotion T_lidar_cam = RigidMotion::Identity();
};

struct DriveScan {
  TimeNs stamp = 0;
  /// LiDAR frame, right-handed, z up, m. Each of these columns may be empty: intensity (up to 1,
  /// 255 or 65535), time (s from the stamp), ring.
  PointCloud points;
};

struct DriveImage {
  std::string camera;  ///< its name
  TimeNs stamp = 0;
  std::variant<Image, std::filesystem::path> content;  ///< a PNG or JPEG file is copied as it is
};

struct DriveWriterOptions {
  bool force = false;              ///< replaces a drive at that place
  bool sweep_compensated = false;  ///< the motion of the LiDAR during a sweep is undone already
  std::optional<SweepTiming> sweep = {};  ///< of points without times
  /// T_lidar_sensor of further LiDARs by name. Scans of all LiDARs have points with times then, or
  /// the timing of `sweep`.
  std::map<std::string, RigidMotion> further_lidars = {};
  std::string first_lidar = "first";  ///< name of the first LiDAR if there are further ones
  bool allow_dropped = false;         ///< however many points cannot be used
};

struct WrittenDrive {
  std::size_t scans = 0;  ///< of all LiDARs
  std::size_t images = 0, poses = 0, points_dropped = 0;
};

/// Writes a drive frame by frame: the base of an adapter for data of another format.
///
///   DriveWriter writer("street", {{.name = "front", ...}});
///   while (...) writer.add({stamp, points}, {{"front", image_stamp, image}}, T_world_lidar);
///   writer.close();
///
/// Without close() nothing stays. Each function throws OutputError if the disk is full or refuses.
class FOVEA_API DriveWriter {
 public:
  /// @throws OutputError            if the folder exists, except a drive with `force`
  /// @throws std::invalid_argument  for a camera that is none, and for a name that occurs twice or
  ///                                has other characters
  DriveWriter(const std::filesystem::path& folder, const std::vector<DriveCamera>& cameras,
              const DriveWriterOptions& options = {});
  ~DriveWriter();
  DriveWriter(DriveWriter&&) noexcept;

  /// Adds the next frame, or nothing if it throws. Images belong to their stamps: a frame may have
  /// any number of them.
  /// @param T_world_lidar  pose at the scan's stamp, in any fixed frame; absent: not known
  /// @throws std::invalid_argument  for a stamp that is not after the one before, an unknown
  ///         camera, an image of another size, a column of another length, or a pose that is none
  /// @throws InputError             if over 10 % of the points so far cannot be used, except with
  ///         `allow_dropped`; for a scan without a usable point, or a damaged image file
  void add(const DriveScan& scan, const std::vector<DriveImage>& images = {},
           const std::optional<RigidMotion>& T_world_lidar = std::nullopt);
  /// Adds a scan of a further LiDAR, in its own frame. It belongs to the frame nearest in time.
  void add_scan(const std::string& lidar, const DriveScan& scan);
  /// Writes the tables, and gives the drive its name. std::logic_error without a scan.
  WrittenDrive close();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace fovea
