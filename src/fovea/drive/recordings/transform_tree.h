// Where frames are in each other: tf.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/geometry/quaternion_motion.h"
#include "fovea/time.h"

namespace fovea {

class TransformTree {
 public:
  /// Where a frame was in its parent.
  struct Link {
    std::map<TimeNs, QuaternionMotion> T_parent_child;  ///< what is fixed: at time 0

    bool moves() const;
    const QuaternionMotion& any() const { return T_parent_child.begin()->second; }
    QuaternionMotion at(TimeNs time) const;  ///< interpolated, and held beyond the ends
  };
  struct Step {
    std::string parent, child;
    Link link;
  };

  /// Takes note of where a frame was in its parent. Of several parents the one told of most often
  /// counts.
  /// @param fixed  whether it is there always (/tf_static)
  void add(const std::string& parent, const std::string& child, TimeNs time,
           const QuaternionMotion& T_parent_child, bool fixed);

  /// Frames of several parents.
  std::vector<std::string> ambiguous() const;

  /// T_a_b of frames that are fixed to each other; of others at any one time that is known. Empty
  /// if the tree does not join them.
  std::optional<QuaternionMotion> fixed(const std::string& a, const std::string& b) const;
  /// The first frame on the way from `a` to `b` that moves (by over a millimetre or a milliradian)
  /// in its parent; empty if none does.
  std::optional<std::string> moving(const std::string& a, const std::string& b) const;

  /// The outermost frame above `frame` between which and `frame` something moves; empty if nothing
  /// does.
  std::optional<std::string> world_of(const std::string& frame) const;

  struct TimedMotion {
    TimeNs time = 0;
    QuaternionMotion T_a_b;
  };
  /// T_a_b of a frame `a` above `b`, at each time for which the moving frame nearest to `b` on the
  /// way is known; the others are interpolated, and held beyond their ends. Empty if `a` is not
  /// above `b` or nothing moves.
  std::vector<TimedMotion> course(const std::string& a, const std::string& b) const;

  /// The links from `b` up to a frame `a` above it. Empty if `a` is not above `b`.
  std::vector<Step> steps(const std::string& a, const std::string& b) const;

  /// The first that moves.
  static std::vector<Step>::const_iterator nearest_moving(const std::vector<Step>& steps);
  /// T_a_b. @param steps  at least one
  static QuaternionMotion motion_at(const std::vector<Step>& steps, TimeNs time);

  /// Keeps the latest transform of each frame.
  void forget_past();

 private:
  /// The frame and all above it.
  std::vector<std::string> ancestors(const std::string& frame) const;
  /// Frames of the way from `a` and from `b` up to what they have in common.
  struct Way {
    std::vector<std::string> from_a, from_b;
  };
  std::optional<Way> way(const std::string& a, const std::string& b) const;

  using Links = std::map<std::string, Link>;  // by parent

  static const Links::value_type& best(const Links& links);
  /// The link of a frame that has a parent.
  const Link& link(const std::string& frame) const { return best(links_.at(frame)).second; }

  std::map<std::string, Links> links_;  // by child
};

}  // namespace fovea
