// Interface of both mappers.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/map/tile_map.h"
#include "fovea/pipeline/frame_result.h"

namespace fovea {

/// Where poses come from.
enum class PoseSource {
  kRefine,
  kNavigation,
  kGiven,
  kGivenFirst,  ///< given for the first frames; those after them are registered
};

/// What to do with a frame.
struct FrameTask {
  /// The frame gets a pose. It adds no point, color or registration target.
  bool held_out = false;
  /// The frame adds no point and no color, since there is no time for it. Registration uses it.
  bool skips_texture = false;
  /// T_local_lidar: of all frames with kGiven, of the first frames with kGivenFirst.
  std::optional<RigidMotion> given_pose = {};
};

/// A frame with its pose; the paper mapper finds the pose in map_frame(). Later frames do not
/// change it.
struct TrackedScan {
  FrameTask task;
  FrameResult result;
  PointCloud scan_lidar;  ///< motion compensated
  /// The registered points if later scans are registered to this scan; else none. LiDAR frame.
  std::vector<Eigen::Vector3f> target_lidar;
  /// T_local_submap of all submaps, and T_local_odom of the latest submap.
  std::vector<RigidMotion> submaps;
  RigidMotion T_local_odom = RigidMotion::Identity();
};

/// Callbacks into the run.
struct MapperServices {
  /// The LiDAR's velocity at a frame without navigation or an earlier frame (initial_velocity).
  std::function<std::optional<Twist>(int frame)> initial_velocity = [](int) {
    return std::nullopt;
  };
  /// Loads the tiles of a ball around the LiDAR, where some of them may be in a store.
  std::function<void(TileMap& map, const Eigen::Vector3d& center_local, double radius)> load_near =
      [](TileMap&, const Eigen::Vector3d&, double) {};
};

using FindScan = std::function<std::optional<PointCloud>(int frame)>;

/// Builds a map frame by frame, in increasing order of the stamps.
class IncrementalMapper {
 public:
  virtual ~IncrementalMapper() = default;

  /// Finds the pose of the next frame.
  virtual TrackedScan track(const Frame& frame, const FrameTask& task) = 0;
  /// Adds the frame's points and colors. May run in parallel with track() of later frames; the map
  /// stays the same.
  virtual FrameResult map_frame(const Frame& frame, TrackedScan tracked) = 0;

  /// Deferred work. Runs in the stage's thread while the stage waits for the next frame, or at the
  /// start of that frame.
  virtual void apply_deferred_tracking() {}
  virtual void apply_deferred_mapping() {}

  virtual const TileMap& map() const = 0;
  virtual TileMap& map() = 0;
  /// Farthest distance from the LiDAR at which a frame uses tiles, m.
  virtual double reach() const = 0;

  /// Continues an earlier run.
  /// @param records  of its frames, in order
  /// @param source   gives the scans that later frames depend on
  virtual void resume(TileMap map, const std::vector<FrameRecord>& records,
                      const FrameSource& source) = 0;

  /// Continues an earlier run of a live drive, whose frames cannot be read again. The motion of
  /// other sensors and evidence of moving objects begin anew.
  /// @param find_scan  gives the motion compensated scan of a frame if the map has it
  virtual void resume_live(TileMap map, const std::vector<FrameRecord>& records,
                           const FindScan& find_scan) = 0;

  /// track() and map_frame().
  FrameResult process(const Frame& frame, const FrameTask& task = {}) {
    return map_frame(frame, track(frame, task));
  }
};

}  // namespace fovea
