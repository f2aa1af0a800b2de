// Publishes poses over the connection that brings the scans.
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fovea/drive/bridge/bridge_messages.h"
#include "fovea/drive/bridge/connection.h"
#include "fovea/drive/bridge/outbox.h"
#include "fovea/drive/bridge/published_pose.h"

namespace fovea::bridge {

///   PosePublisher poses;            // lives longer than read_bridge
///   options.poses = &poses;         // BridgeOptions
///   poses.publish({frame, stamp, T_world_lidar, covariance, "tracked"});  // any thread
///
/// publish(), counts() and sent() may be called by any thread. The others are for read_bridge.
class PosePublisher {
 public:
  static constexpr std::size_t kMostUnsent = 32;  ///< poses: about 3 s of a LiDAR of 10 Hz

  /// Appends a pose to those that read_bridge sends, and never waits. If the bridge does not take
  /// the earlier ones, the oldest unsent pose is dropped.
  void publish(PublishedPose pose) { unsent_.post(std::move(pose)); }

  using Counts = Outbox<PublishedPose>::Counts;
  Counts counts() const { return unsent_.counts(); }
  /// Poses that were passed to a connection.
  std::size_t sent() const { return sent_; }

  /// The connection sends the poses from now on, after its bridge has sent its information.
  void begin(Connection& connection);
  /// Offers the topics of poses, if the bridge accepts them.
  void take(const ServerInfo& info, Connection& connection);
  /// Before the connection is destroyed.
  void end();

  /// Why poses were not published. At most one.
  std::vector<std::string> warnings() const;

 private:
  std::optional<WireMessage> next();

  Outbox<PublishedPose> unsent_{kMostUnsent};
  std::vector<ClientChannel> channels_;  // offered on this connection
  std::deque<std::string> messages_;     // of the last pose that was taken, unsent
  std::string refusal_;
  std::atomic<std::size_t> sent_ = 0;
};

}  // namespace fovea::bridge
