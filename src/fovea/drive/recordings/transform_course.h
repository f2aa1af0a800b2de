// Poses by tf, while its messages come.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/drive/recordings/transform_tree.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// T_world_body, as TransformTree::course() gives it for a whole recording. Memory is bounded.
class TransformCourse {
 public:
  /// @param tree  the transforms so far. In them, a frame moves between `world` and `body`.
  TransformCourse(const TransformTree& tree, const std::string& world, const std::string& body);

  /// @return the poses that are known now, in order of time, each once
  std::vector<RecordedPose> add(const std::vector<ros::Transform>& transforms);

 private:
  using Links = std::vector<TransformTree::Step>;

  bool is_known(TimeNs time) const;
  std::vector<RecordedPose> known_poses();
  void forget_past();

  Links steps_;              // from the body to the world
  std::size_t nearest_;      // the one to the body that moves
  TimeNs latest_ = 0;        // of the poses that were returned
  std::vector<bool> moves_;  // of each step, so far
};

}  // namespace fovea
