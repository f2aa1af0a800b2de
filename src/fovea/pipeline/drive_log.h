// Poses of the frames of a run, which change when submaps move. Keeps little for each frame, since
// a drive may be long.
#pragma once

#include <vector>

#include "fovea/map/checkpointer.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/tile_map.h"

namespace fovea {

class DriveLog {
 public:
  /// Adds the next frame. Keeps its record until the next rows().
  void add(FrameRecord record);
  /// Adds the next frame of an earlier run, whose record is in the map file.
  void add_stored(const FrameRecord& record);

  std::size_t size() const { return frames_.size(); }
  /// Number of records that rows() has not yet returned.
  std::size_t fresh() const { return fresh_.size(); }
  /// Whether any frame so far was not skipped.
  bool has_mapped() const;

  /// The new records with their present poses, and the poses of earlier frames and submaps that
  /// have moved since the last call. Without `exact`, very small motions do not count. The pose of
  /// a skipped frame is interpolated between its neighbors by index.
  MapRows rows(const TileMap& map, bool exact);

 private:
  struct Frame {
    int index = 0, submap = -1;  // -1: skipped
    RigidMotion T_odom_lidar = RigidMotion::Identity();
    RigidMotion T_local_lidar = RigidMotion::Identity();  // as last returned
  };
  void remember(const FrameRecord& record);
  /// T_local_lidar of each frame.
  std::vector<RigidMotion> poses(const TileMap& map) const;

  std::vector<Frame> frames_;
  std::vector<FrameRecord> fresh_;          // of the last frames
  std::vector<RigidMotion> T_odom_submap_;  // by submap
  std::vector<SubmapRecord> submaps_;       // as last returned
};

}  // namespace fovea
