// KITTI's tracklet_labels.xml of a simulated drive: boxes round cars, cyclists and people, whether
// they move or stand (Geiger, Lenz, Stiller, Urtasun 2013, "Vision meets Robotics", IJRR).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "fovea/simulation/lidar_model.h"
#include "fovea/simulation/ray_caster.h"
#include "fovea/simulation/rig.h"
#include "fovea/simulation/vehicle_motion.h"

namespace fovea {

/// KITTI's states of a box in an image.
enum class BoxOcclusion { kVisible = 0, kPartly = 1, kFully = 2 };
enum class BoxTruncation { kInImage = 0, kTruncated = 1, kOutOfImage = 2, kBehindImage = 99 };

/// A box in one frame.
struct BoxLabel {
  RigidMotion T_lidar_box = RigidMotion::Identity();  ///< the middle of its bottom; x its length
  bool seen = false;                                  ///< the LiDAR had returns from it
  BoxOcclusion occlusion = BoxOcclusion::kVisible;
  BoxTruncation truncation = BoxTruncation::kInImage;
};

/// One thing over the frames that follow each other.
struct BoxTrack {
  std::string type;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< length, width, height (m)
  int first_frame = 0;
  std::vector<BoxLabel> boxes;
};

/// The file's text.
std::string tracklets_text(const std::vector<BoxTrack>& tracks);

/// How much of a box (its eight corners, in the camera's frame) an image contains.
BoxTruncation truncation_of(const std::array<Eigen::Vector3d, 8>& corners_cam,
                            const Camera& camera);

/// Labels the things of a scenery that have a label, frame by frame, from the first in which the
/// LiDAR has a return from them to the last. A box is the thing's bounding box where the thing was
/// when the sweep passed it: that is where its points are. The scan's stamp, to which the sweep's
/// motion is undone, would be up to half a metre off for a car that comes towards the vehicle.
class TrackletLabels {
 public:
  /// Keeps references to all three. The image of occlusion and truncation is the first camera's; a
  /// rig without one has everything out of the image.
  TrackletLabels(const Scenery& scenery, const VehicleMotion& motion, const Rig& rig);

  /// Frames in their order, none left out.
  /// @param caster  resident round the vehicle
  /// @param stamp   of the scan (s from frame 0's)
  void add(int frame, double stamp, const SimulatedScan& scan, const RayCaster& caster);

  /// In the order in which the things were met first.
  std::vector<BoxTrack> tracks() const;

 private:
  struct Track {
    BoxTrack labels;
    RigidMotion T_world_model = RigidMotion::Identity();  ///< last
    std::size_t until_seen = 0;                           ///< boxes up to the last with a return
    int last_frame = 0;
  };
  struct Sight;

  std::vector<Placement> things_near(const Eigen::Vector3d& lidar_world, double time);
  BoxLabel label_of(const Placement& thing, const Sight& sight) const;
  BoxOcclusion occlusion_of(const Placement& thing, const Sight& sight) const;
  Track& track_of(const Placement& thing, int frame);

  const Scenery& scenery_;
  const VehicleMotion& motion_;
  const Rig& rig_;
  std::vector<Eigen::AlignedBox3d> bounds_;                   // of the models
  std::map<std::uint32_t, std::vector<Placement>> standing_;  // by chunk
  std::vector<Track> tracks_;
  std::map<std::uint32_t, std::size_t> open_;  // by surface: place in tracks_
};

}  // namespace fovea
