// Frames of sensors that measure while the map grows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>

#include "fovea/core/messages.h"
#include "fovea/core/wall_clock.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// One sweep of a LiDAR.
struct LiveScan {
  std::string lidar;  ///< its name; empty: the drive has one LiDAR
  TimeNs stamp = 0;
  /// LiDAR frame, m, as measured. May have intensity (0 to intensity_max of drive.toml), time (s
  /// from the stamp) and ring.
  PointCloud points;
  DroppedPoints dropped = {};  ///< not in `points`
};

/// An image of a camera, as the camera took it.
struct LiveImage {
  std::string camera;  ///< its name
  TimeNs stamp = 0;
  std::variant<Image, std::string> content;  ///< pixels, or the bytes of a PNG or JPEG file
  std::optional<double> exposure = {};       ///< s, times the amplification
};

struct LiveOptions {
  /// Of the source in messages, such as "ws://robot:8765".
  std::string name = "live";
  /// Which cameras and sensors are used. Its range of frames is not used.
  DriveOptions drive;
  /// s from the arrival of a scan: the frame then comes without the images and positions that are
  /// not there yet.
  double max_wait = 0.3;
  /// Scans from which units, delays and the profile of the LiDAR are derived.
  std::size_t first_scans = 10;
  /// s for these scans and for the first images and positions, from the first scan.
  double longest_beginning = 5;
  /// Whether begin() waits for poses or positions, too, if none has come with the first scans.
  bool expects_navigation = false;
  std::size_t max_scans = 24;  ///< that wait to become frames, for each LiDAR
  /// A full queue makes add_scan() wait. Otherwise the oldest scan is dropped, and counted.
  bool waits = false;
  /// With `waits`: all data come from one thread. While it waits for room nothing else comes, so a
  /// frame then waits no longer, and no other wait has an end: frames do not depend on the clock.
  bool has_one_sender = false;
  /// Continues an earlier run: the number of the next frame, and the origin of its frame `local`.
  int first_frame = 0;
  std::optional<GeodeticPoint> origin;
  std::optional<Eigen::Vector3d> world_origin;  ///< of poses in a world without coordinates
  /// s, Camera::image_delay by the camera's number; absent: from the first images.
  std::map<int, double> image_delays;
  /// Writes the accepted frames as a drive (docs/drives.md); empty: none.
  std::filesystem::path record;
};

/// A frame, or a scan that could not become one.
struct LiveFrame {
  LoadedFrame frame;
  WallClock::time_point arrival;  ///< of its scan
  double decode_ms = 0;           ///< wall time of decoding
};

/// What came, and what was not used. Its warnings name jumps of clocks, gaps, and sensors that
/// stopped or began later.
struct LiveFigures : Messages {
  std::size_t scans = 0, images = 0, poses = 0;
  std::size_t scans_dropped = 0;       ///< the queue was full
  std::size_t scans_out_of_order = 0;  ///< not later than the scan before
  std::size_t scans_missing = 0;       ///< by gaps in the stamps
  std::size_t images_late = 0;         ///< came after the frame that they belong to
  std::size_t images_missing = 0;      ///< by gaps in the stamps
  std::size_t images_unused = 0;       ///< belong to no scan
  std::size_t poses_late = 0;          ///< of navigation, IMU and wheels: not later than before
};

/// Makes frames of scans, images and positions that arrive from any thread, in any order of the
/// sensors. Each sensor's data come in the order of their stamps. Images and positions are matched
/// to scans by their stamps. Memory is bounded.
///
///   LiveSource source(drive_toml, {});
///   std::jthread sensor([&] { while (...) source.add_scan(...); source.close(); });
///   const MapSummary summary = map_live(source, job);
class LiveSource {
 public:
  /// @param drive_toml  describes the sensors (docs/drives.md); its folders are not used
  /// @throws ConfigError  as read_drive_description(), and for cameras that it lacks
  LiveSource(std::string_view drive_toml, const LiveOptions& options);
  ~LiveSource();

  // From any thread. Data of a sensor that drive.toml lacks are std::invalid_argument; data after
  // close() are dropped. Data that cannot be used are counted.
  void add_scan(LiveScan scan);
  void add_image(LiveImage image);
  void add_pose(const RecordedPose& pose);
  void add_position(const RecordedPosition& position);
  void add_inertia(const RecordedInertia& inertia);
  void add_wheel_speed(const WheelSpeed& speed);
  /// No data follow. The frames at hand still come.
  void close();

  // From one thread, the one that maps.

  /// Waits for the first scans, and for images and positions if they come in time. Returns these
  /// first frames, whose DriveInfo is that of the whole drive. Nullptr if the source is closed
  /// without a scan, or if `stop` is requested.
  /// @throws InputError  as open_drive(), for sensors that are no drive
  std::unique_ptr<FrameSource> begin(const std::stop_token& stop);
  /// The next frame, from the first one on; waits for it. Nothing after close(), or if `stop` is
  /// requested. begin() comes first.
  std::optional<LiveFrame> next(const std::stop_token& stop);
  /// What begin() waits for: "images of camera front"; empty if it waits for nothing.
  std::string missing() const;
  /// Origin of `local` in the world of poses without coordinates; absent if there are none.
  std::optional<Eigen::Vector3d> world_origin() const;
  /// Ends the recording. OutputError if it could not be written.
  void finish_recording();
  LiveFigures figures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea
