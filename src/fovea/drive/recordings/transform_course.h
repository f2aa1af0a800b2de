// Poses by tf, while its messages come.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/drive/recordings/transform_tree.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// T_world_body, as TransformTree::course() gives it for a whole recording. Memory is bounded.
///
/// Stamps may go back, as when the robot's clock is set. Then the poses do, too. A single stamp far
/// from those before and after it is left out.
class TransformCourse {
 public:
  /// @param tree  the transforms so far. In them, a frame moves between `world` and `body`.
  TransformCourse(const TransformTree& tree, const std::string& world, const std::string& body);

  static constexpr TimeNs kMaxAge = 60 * kNsPerSecond;   ///< of a transform, to its next ones
  static constexpr std::size_t kMaxTransforms = 10'000;  ///< of a frame in its parent

  /// @return the poses that are known now, each once. They are in order of time, unless stamps go
  ///         back.
  std::vector<RecordedPose> add(const std::vector<ros::Transform>& transforms);
  /// Transforms in memory.
  std::size_t size() const;

 private:
  using Links = std::vector<TransformTree::Step>;

  /// @param k  of the step
  void add(std::size_t k, const TransformTree::TimedMotion& transform);
  /// Drops the transforms of a step, and those of the others that are later than `time`.
  void restart(std::size_t k, TimeNs time);
  bool is_known(TimeNs time) const;
  std::vector<RecordedPose> known_poses();
  void forget_past();
  /// Bounds the transforms of a step, also while those nearest to the body do not come.
  void limit(std::size_t k);

  Links steps_;              // from the body to the world
  std::size_t nearest_;      // the one to the body that moves
  TimeNs latest_ = 0;        // of the poses that were returned
  std::vector<bool> moves_;  // of each step, so far
  /// Of each step: a transform whose stamp is far from those before it, until the next one comes.
  std::vector<std::optional<TransformTree::TimedMotion>> far_;
};

}  // namespace fovea
