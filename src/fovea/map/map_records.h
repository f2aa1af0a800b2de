// What a map keeps of its drives, sensors, submaps and keyframes, and the state for resuming
// (docs/map-format.md). Frames are in frame_record.h.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fovea/geometry/geodesy.h"
#include "fovea/geometry/sensor_profile.h"
#include "fovea/rigid_motion.h"

namespace fovea {

inline constexpr const char* kWgs84 = "WGS 84";

/// "ellipsoidal" or "orthometric".
const char* to_string(HeightType type);

/// A drive of the map: its identity and where it is on the earth.
struct DriveRecord {
  std::string name;                    ///< of its folder
  std::string kind;                    ///< DriveInfo::kind
  std::optional<std::string> session;  ///< recording day in UTC, "2011-09-26"
  /// Hashes that identify the drive (drive_fingerprint.h); absent where they are unknown.
  std::optional<std::string> calibration_fingerprint, stamps_fingerprint;
  int first_frame = 0, end_frame = 0;  ///< frame numbers in this map, half-open
  int frame_shift = 0;                 ///< a frame's number in this map minus that in the drive
  /// From the local frame of the drive's own map to that of this map.
  RigidMotion T_local_drive = RigidMotion::Identity();
  std::optional<GeodeticPoint> origin;  ///< of the drive's own local frame
  std::optional<std::string> datum;     ///< of the origin
  std::optional<double> epoch_year;     ///< of the datum, as a decimal year
  std::optional<HeightType> height_type;
  std::optional<std::string> source_digest;  ///< of the map that fovea merge took the drive from

  bool has_frame(int frame) const { return first_frame <= frame && frame < end_frame; }
};
/// Number of the drive of a frame; the number of drives if it belongs to none.
std::size_t drive_of_frame(const std::vector<DriveRecord>& drives, int frame);

/// A LiDAR of a drive.
struct SensorRecord {
  int drive = 0;  ///< number of the drive
  RigidMotion T_lidar_sensor = RigidMotion::Identity();
  SensorProfile profile;
};

struct SubmapRecord {
  RigidMotion T_local_submap = RigidMotion::Identity();
  int drive = 0;  ///< number of the drive
  /// Of the pose, as a twist in the submap's frame, rotation first (rad, m).
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
  /// Base-2 logarithms of factors for red, green and blue: from the colors of the tiles to the
  /// exposure of the map. Absent: no change.
  std::optional<Eigen::Vector3d> log2_gain;
};

/// What one sensor measured in a keyframe, at the stamp of the frame.
struct KeyframeRecord {
  int frame = 0;
  int sensor = 0;                  ///< number of the sensor
  std::vector<double> elevations;  ///< rad, of the rows
  std::size_t columns = 0;
  double first_azimuth = 0, azimuth_step = 0;  ///< rad, of the columns, in the sensor's frame
  /// Whole centimeters, row by row; 0: no return; 65535: 655.35 m or more.
  std::vector<std::uint16_t> ranges;
};

/// Largest number of pixels of a range image.
inline constexpr std::size_t kMaxRangePixels = std::size_t{1} << 22;
/// Largest size of the state in a checkpoint, bytes.
inline constexpr std::size_t kMaxCheckpointSize = std::size_t{1} << 30;

/// State of a stage after a frame, for resuming a run whose drive cannot be read again.
struct CheckpointRecord {
  int frame = 0;  ///< the last frame that the state contains
  std::vector<std::byte> state;
};

}  // namespace fovea
