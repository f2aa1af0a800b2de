// What a live map keeps to be continued: a live drive cannot be read again.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "fovea/drive/live/live_source.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// A scan that later scans are registered to.
struct TargetScan {
  int frame = 0;
  std::vector<Eigen::Vector3f> points_lidar;  ///< motion compensated, thinned
};

struct LiveState {
  std::map<int, double> image_delays;           ///< s, Camera::image_delay by number
  std::optional<Eigen::Vector3d> world_origin;  ///< LiveSource::world_origin()
  std::deque<TargetScan> targets;               ///< the latest, in order
};

/// @param last_frame  that the map has
CheckpointRecord checkpoint_of(const LiveState& state, int last_frame);
inline constexpr const char* kLiveState = "live";

/// InputError if the record is damaged.
LiveState live_state(const CheckpointRecord& record);
/// The state in a map; nothing if the map is not of a live drive. InputError if it is damaged.
std::optional<LiveState> live_state(const MapReader& map);

/// The options of a source that continues a map.
/// @throws InputError  if the map cannot be read, or is not of a live drive
void continue_map(const std::filesystem::path& map, LiveOptions& options);

/// The scans that a map of a live drive has: those to register to, and of each submap a coarse one
/// for loop closures.
class EarlierScans {
 public:
  explicit EarlierScans(const MapReader& map, const LiveState& state);
  /// Motion compensated, LiDAR frame.
  std::optional<PointCloud> find(int frame) const;

 private:
  std::map<int, PointCloud> scans_;
};

}  // namespace fovea
