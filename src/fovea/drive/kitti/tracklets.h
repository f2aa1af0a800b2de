// KITTI tracklets: boxes that people have drawn around cars, cyclists and pedestrians of a raw
// drive (Geiger, Lenz, Stiller, Urtasun 2013, "Vision meets Robotics: The KITTI Dataset", IJRR).
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/rigid_motion.h"

namespace fovea {

/// One thing over the frames in which it is labelled.
struct Tracklet {
  std::string type;                                ///< "Car", "Pedestrian", ...
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< length, width, height (m)
  int first_frame = 0;                             ///< of the drive
  /// T_lidar_box of the first frame and each that follows; the box's origin is the middle of its
  /// bottom, x along its length, z up.
  std::vector<RigidMotion> T_lidar_box;

  /// Pose at a frame; null where it is not labelled.
  const RigidMotion* at(int frame) const;
  /// Whether a point (LiDAR frame of `frame`) lies in the box or at most `margin` (m) outside.
  bool contains(int frame, const Eigen::Vector3d& p_lidar, double margin) const;
};

/// The drive's tracklet file: `tracklet_labels.xml` in its folder or, as the benchmark's archive is
/// named, in DATE_drive_NNNN_tracklets beside it. Nothing if it has none. A calibrated drive has
/// the file of the drive that it corrects.
std::optional<std::filesystem::path> find_tracklets(const std::filesystem::path& drive);

/// InputError, which names the file and the place, if it is no tracklet file or damaged.
std::vector<Tracklet> read_tracklets(const std::filesystem::path& file);

}  // namespace fovea
