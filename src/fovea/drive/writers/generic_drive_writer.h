// Writes a drive as a folder with a drive.toml (docs/drives.md), whatever it was recorded with.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/output_folder.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/geometry/imu_data.h"
#include "fovea/geometry/lens.h"
#include "fovea/geometry/quaternion_motion.h"
#include "fovea/geometry/sensor_profile.h"
#include "fovea/image.h"
#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"
#include "fovea/time.h"

namespace fovea {

struct RecordedCamera {
  std::string name;  ///< letters, digits, '_' and '-'
  int index = 0;     ///< 0 to 9
  LensCamera optics;
  QuaternionMotion T_lidar_cam;
};

struct RecordedLidar {
  std::string name;  ///< letters, digits, '_' and '-'; empty: the drive has one LiDAR
  bool sweep_compensated = false;
  std::optional<SweepTiming> sweep;  ///< of points without times; absent: drive.toml states none
  double intensity_max = 1;  ///< the intensity in the scans that stands for a reflectance of 1
  QuaternionMotion T_lidar_sensor;  ///< of further LiDARs
};

/// A line of poses.csv.
struct RecordedPose {
  TimeNs time = 0;
  QuaternionMotion T_world_body;
};

/// A line of gnss.csv.
struct RecordedPosition {
  TimeNs time = 0;
  GeodeticPoint antenna;
  double accuracy = 0;  ///< standard deviation of a coordinate (m); 0: not known, infinite: no fix
  std::optional<Eigen::Vector3d> roll_pitch_yaw;  ///< rad, as in oxts.h
  std::optional<Twist> velocity = {};             ///< of the body in its own frame, a second
};

/// A line of imu.csv.
struct RecordedInertia {
  TimeNs time = 0;
  std::optional<Eigen::Quaterniond> R_enu_imu;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();      ///< m/s^2, gravity included
};

enum class ScanFile {
  kPcd,      ///< x y z intensity, and the time and ring of the points where the scan has them
  kKittiBin  ///< x y z intensity; std::invalid_argument for a scan with times
};

/// All of a drive but its scans and images. Its numbers are written as they are: reading them gives
/// each to the last digit.
struct RecordedDrive {
  std::vector<RecordedCamera> cameras;
  RecordedLidar lidar;                        ///< its frame is `lidar`
  std::vector<RecordedLidar> further_lidars;  ///< if there are any, all have names
  QuaternionMotion T_body_lidar, T_body_imu;
  Eigen::Vector3d antenna_body = Eigen::Vector3d::Zero();
  std::vector<RecordedPose> poses;          ///< where there are any, positions are not looked at
  std::vector<RecordedPosition> positions;  ///< all with an attitude, or none
  std::vector<RecordedInertia> inertia;     ///< all with an orientation, or none
  /// Of the rates and accelerations of `inertia`; absent: their place is not known.
  std::optional<QuaternionMotion> T_lidar_imu;
  std::vector<WheelSpeed> wheels;
};

/// The text of drive.toml.
std::string drive_toml(const RecordedDrive& drive);

/// Everything is written below ROOT.partial, which becomes ROOT when finish() is called; what was
/// not finished is removed. Every function throws OutputError where the disk is full or refuses.
/// Scans and images may be written at once, from several threads.
class GenericDriveWriter {
 public:
  /// OutputError where anything exists at ROOT (with `force`: anything but such a drive), its
  /// parent does not, or another program is writing it.
  explicit GenericDriveWriter(const std::filesystem::path& root, bool force = false);

  /// std::invalid_argument for a scan with times that is to be KITTI's, and for a name that
  /// RecordedLidar does not allow.
  /// @param lidar  name of the LiDAR; empty: the drive has one
  void write_scan(int number, TimeNs stamp, const PointCloud& scan_sensor,
                  ScanFile format = ScanFile::kPcd, const std::string& lidar = "");
  /// As PNG. std::invalid_argument for a name that RecordedCamera does not allow.
  void write_image(const std::string& camera, int number, TimeNs stamp, const Image& image);
  /// States the exposure time of an image, s.
  void set_exposure(const std::string& camera, int number, double exposure);
  /// An image that is encoded already; as above.
  /// @param extension  ".png" or ".jpg"
  void write_encoded_image(const std::string& camera, int number, TimeNs stamp,
                           std::string_view bytes, const std::string& extension);
  /// A file beside the recording: of truth/ (docs/simulator.md) or depth/, or tracklet_labels.xml.
  void write_file(const std::filesystem::path& name, std::string_view bytes) const;
  /// Writes the stamps and exposures so far, and forgets them: memory is bounded. Further scans and
  /// images have higher numbers.
  void flush_stamps();
  /// Appends rows to a table of the drive. A new one gets the header.
  void append_rows(const std::filesystem::path& name, std::string_view header,
                   std::string_view rows) const;
  /// Where the drive grows, for what writes files itself, of it or for a while.
  const std::filesystem::path& folder() const { return folder_.partial(); }
  /// Folder of the truth.
  std::filesystem::path truth_folder() const { return folder_.partial() / "truth"; }

  /// Writes drive.toml and the tables, makes everything durable and gives ROOT its name.
  void finish(const RecordedDrive& drive);
  /// The same for a drive.toml of the caller, who has written the tables of motion into folder().
  void finish(std::string_view drive_toml);

 private:
  using Stamps = std::map<int, TimeNs>;

  void write_stamps();

  OutputFolder folder_;
  std::mutex mutex_;                                        // of the stamps
  std::map<std::string, Stamps> scan_stamps_;               // by LiDAR
  std::map<std::string, Stamps> image_stamps_;              // by camera
  std::map<std::string, std::map<int, double>> exposures_;  // by camera, s
  /// A table that was begun has exposures, since later images may state some.
  bool are_exposures_flushed_ = false;
};

}  // namespace fovea
