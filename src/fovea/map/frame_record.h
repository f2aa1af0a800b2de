// What the map keeps of every frame of the range mapped: the `frames` table.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/view_light.h"
#include "fovea/map.h"
#include "fovea/sweep_motion.h"
#include "fovea/time.h"

namespace fovea {

/// The status of that name, or nothing.
std::optional<FrameStatus> frame_status(std::string_view name);

/// A place of an earlier submap that a frame's scan was registered to.
struct Revisit {
  int submap = 0;
  RigidMotion T_submap_lidar = RigidMotion::Identity();
};

/// A count as FrameRecord::figures has it.
inline double as_figure(std::size_t count) { return static_cast<double>(count); }

/// Gains of an image relative to the colors of an earlier submap that it shows, as log2_gain.
struct RevisitedColors {
  int submap = 0;
  Eigen::Vector3d log2_gain = Eigen::Vector3d::Zero();

  bool operator==(const RevisitedColors&) const = default;
};

/// The image of one camera in a frame: the `views` table.
struct ViewRecord {
  int camera = 0;
  std::optional<TimeNs> stamp;  ///< when the image was taken
  /// Base-2 logarithms of the gains for red, green and blue: image = map * gain. Absent where
  /// nothing has estimated them. In the file they are relative to the frame's submap.
  std::optional<Eigen::Vector3d> log2_gain = {};
  CameraResponse response = {};  ///< under which the gain was estimated
  /// The most frequent color in view, base-2 logarithms of map values; relative to the frame's
  /// submap in the file.
  std::optional<Eigen::Vector3d> log2_color = {};
  std::optional<RevisitedColors> revisit = {};

  bool operator==(const ViewRecord&) const = default;
  /// How the image shows the colors of the map.
  ViewLight light() const;
};

struct FrameRecord {
  int index = 0;
  std::optional<TimeNs> stamp;
  FrameStatus status = FrameStatus::kMapped;
  std::string note;  ///< why it was skipped, or what a user should know of it
  /// Refined pose; of a skipped frame interpolated between its neighbours.
  RigidMotion T_local_lidar = RigidMotion::Identity();
  std::optional<RigidMotion> T_local_lidar_navigation;
  /// Pose in the frame that never jumps (docs/method.md 2.6), and the submap whose motion in local
  /// the frame follows; -1 of a skipped frame.
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  int submap = -1;
  std::optional<Revisit> revisit;
  /// Of the LiDAR at the stamp: undoes the sweep, and moves the cameras to their images. Absent
  /// where the drive needs neither.
  std::optional<SweepMotion> motion;
  std::vector<ViewRecord> views;  ///< of the images that were used, by camera
  /// Per-stage figures by name ("points_scan", "registration_iterations", "filter_occluded", ...),
  /// part of the digest.
  std::map<std::string, double> figures;
  /// Wall time by stage name, ms; not part of the digest.
  std::map<std::string, double> milliseconds;

  /// Whether a figure is there and above zero.
  bool has(const std::string& figure) const;
  /// Counts an image that the camera has not given, or not one that can be read: the figures
  /// "images_missing" and "images_missing_K".
  void count_missing_image(int camera);
  bool lacks_image(int camera) const;
  /// The image of a camera; null if none was used.
  const ViewRecord* find_view(int camera) const;
};

}  // namespace fovea
