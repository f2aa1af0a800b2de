// What a run remembers of the frames behind it: enough to say where each of them is when its submap
// moves, and no more, since a drive may be long.
#pragma once

#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/map/map_keeper.h"
#include "fovea/map/tile_map.h"

namespace fovea {

class DriveLog {
 public:
  /// The next frame. Its record is kept until rows() hands it on.
  void add(FrameRecord record);
  /// The next frame of an earlier run, which the map file has.
  void add_stored(const FrameRecord& record);

  std::size_t size() const { return frames_.size(); }
  /// Frames whose records have not been handed on.
  std::size_t fresh() const { return fresh_.size(); }
  /// Whether any frame so far was not skipped.
  bool has_mapped() const;

  /// The new records, under the poses that the map's submaps give them now, and the poses of
  /// earlier frames and of submaps that have moved since they were handed on: noticeably, or if
  /// `exact` at all. A skipped frame lies between its neighbours, by index.
  MapRows rows(const TileMap& map, bool exact);

 private:
  struct Frame {
    int index = 0, submap = -1;  // -1: skipped
    RigidMotion T_odom_lidar = RigidMotion::Identity();
    RigidMotion T_local_lidar = RigidMotion::Identity();  // as handed on
  };
  void remember(const FrameRecord& record);
  /// T_local_lidar of each frame.
  std::vector<RigidMotion> poses(const TileMap& map) const;

  std::vector<Frame> frames_;
  std::vector<FrameRecord> fresh_;           // of the last frames
  std::vector<RigidMotion> T_odom_submap_;   // by submap
  std::vector<RigidMotion> T_local_submap_;  // as handed on
};

}  // namespace fovea
