// Maps of sensors that measure while the map grows.
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fovea/image.h"
#include "fovea/mapper.h"
#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"
#include "fovea/time.h"

namespace fovea {

/// Pose of a frame, before the frame is in the map.
struct LivePose {
  int index = 0;
  TimeNs stamp = 0;
  std::string state;  ///< "tracked", "lost" or "restarted"
  RigidMotion T_local_lidar = RigidMotion::Identity();
  /// Of a twist of the LiDAR in its own frame, rotation first (rad^2, m^2); absent: not known.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
};

struct LiveMapperOptions {
  MapperSettings settings = {};
  std::vector<int> cameras = {};    ///< numbers; empty: as in DriveOptions
  bool expects_navigation = false;  ///< the beginning waits for poses or positions
  double max_wait = 0.3;            ///< s from the arrival of a scan, for its images and positions
  bool every_frame = false;         ///< full queues make the add functions wait: nothing is dropped
  bool resume = false;              ///< continues the map of an earlier run
  bool force = false;               ///< replaces a map
  std::filesystem::path record = {};  ///< writes the accepted frames as a drive; empty: none
  int threads = 0;                    ///< 0: all that the machine has
  /// Called in the tracker's thread; must be fast.
  std::function<void(const LivePose&)> on_pose = {};
};

/// A position by GNSS.
struct GnssPosition {
  double latitude = 0, longitude = 0;  ///< degrees
  double altitude = 0;                 ///< m above the ellipsoid
  double accuracy = 0;                 ///< standard deviation of a coordinate, m; 0: not known
  std::optional<Eigen::Vector3d> roll_pitch_yaw = {};  ///< rad; yaw from east, counterclockwise
};

/// Maps what sensors send while they measure (docs/live.md).
///
///   LiveMapper mapper(drive_toml, "street.fovea");
///   // in the sensors' threads:
///   mapper.add_scan(stamp, points);
///   mapper.add_image("front", image_stamp, image);
///   // in the end:
///   const MapFigures figures = mapper.close();
///
/// The add functions may be called from any thread. The data of each sensor come in the order of
/// their stamps, the sensors in any order. An error of the map is thrown by the next call.
class FOVEA_API LiveMapper {
 public:
  /// @param drive_toml  describes the sensors (docs/drives.md); its folders are not used
  /// @throws ConfigError  for sensors or settings that are none
  /// @throws OutputError  if the output exists, except with `force` or `resume`
  LiveMapper(std::string_view drive_toml, const std::filesystem::path& output,
             const LiveMapperOptions& options = {});
  /// Ends the map with the frames at hand.
  ~LiveMapper();
  LiveMapper(const LiveMapper&) = delete;
  LiveMapper& operator=(const LiveMapper&) = delete;

  /// @param points  LiDAR frame, m, as measured; may have intensity, time (s from the stamp), ring
  /// @param lidar   its name; empty: the drive has one LiDAR
  void add_scan(TimeNs stamp, PointCloud points, const std::string& lidar = "");
  /// @param content  pixels, or the bytes of a PNG or JPEG file
  /// @param exposure  s, times the amplification
  void add_image(const std::string& camera, TimeNs stamp, std::variant<Image, std::string> content,
                 std::optional<double> exposure = std::nullopt);
  void add_pose(TimeNs stamp, const RigidMotion& T_world_body);
  void add_position(TimeNs stamp, const GnssPosition& position);
  /// @param angular_velocity  rad/s
  /// @param acceleration      m/s^2, gravity included
  /// @param R_enu_imu         absent: the IMU gives no orientation
  void add_imu(TimeNs stamp, const Eigen::Vector3d& angular_velocity,
               const Eigen::Vector3d& acceleration,
               const std::optional<Eigen::Matrix3d>& R_enu_imu = std::nullopt);
  void add_wheel_speed(TimeNs stamp, double speed);  ///< m/s

  /// What the beginning waits for: "images of camera front"; empty: nothing.
  std::string missing() const;
  /// Counts of what came and of what was not used so far, by name (docs/live.md).
  std::map<std::string, std::size_t> figures() const;
  /// Ends the map early, with the frames at hand. Does not wait; on_pose may call it.
  void stop();
  /// Takes no more data, and waits for the map, but not longer than `time`.
  /// @return false if the map has not ended; otherwise close() does not wait
  bool close_within(std::chrono::milliseconds time);
  /// Completes the map with the frames at hand.
  /// @throws InputError  if no frame could begin
  MapFigures close();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace fovea
