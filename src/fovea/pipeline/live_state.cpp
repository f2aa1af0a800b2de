#include "fovea/pipeline/live_state.h"

#include <cstring>
#include <nlohmann/json.hpp>

#include "fovea/core/errors.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/map/keyframe_returns.h"
#include "fovea/map/map_meta.h"

namespace fovea {
namespace {

using nlohmann::json;

constexpr float kVoxel = 0.5;  // m, of scans for loop closures: memory grows by 50 kB a submap

json::binary_t bytes_of(const std::vector<Eigen::Vector3f>& points) {
  json::binary_t bytes;
  bytes.resize(points.size() * sizeof(Eigen::Vector3f));
  if (!points.empty()) std::memcpy(bytes.data(), points.front().data(), bytes.size());
  return bytes;
}

std::vector<Eigen::Vector3f> points_of(const json::binary_t& bytes) {
  std::vector<Eigen::Vector3f> points(bytes.size() / sizeof(Eigen::Vector3f));
  if (!points.empty()) {
    std::memcpy(points.front().data(), bytes.data(), points.size() * sizeof(Eigen::Vector3f));
  }
  return points;
}

LiveState state_of(const CheckpointRecord& record) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(record.state.data());
  const json stored = json::from_cbor(bytes, bytes + record.state.size());
  LiveState state;
  for (const json& camera : stored.at("cameras")) {
    state.image_delays[camera.at("number")] = camera.at("delay");
  }
  if (stored.contains("world_origin")) {
    const auto origin = stored.at("world_origin").get<std::array<double, 3>>();
    state.world_origin = Eigen::Vector3d(origin[0], origin[1], origin[2]);
  }
  for (const json& target : stored.at("targets")) {
    state.targets.push_back({target.at("frame"), points_of(target.at("points").get_binary())});
  }
  return state;
}

}  // namespace

CheckpointRecord checkpoint_of(const LiveState& state, int last_frame) {
  json stored = {{"cameras", json::array()}, {"targets", json::array()}};
  for (const auto& [number, delay] : state.image_delays) {
    stored["cameras"].push_back({{"number", number}, {"delay", delay}});
  }
  if (state.world_origin) {
    stored["world_origin"] = {state.world_origin->x(), state.world_origin->y(),
                              state.world_origin->z()};
  }
  for (const TargetScan& target : state.targets) {
    stored["targets"].push_back(
        {{"frame", target.frame}, {"points", json::binary(bytes_of(target.points_lidar))}});
  }
  CheckpointRecord record{last_frame, {}};
  const std::vector<std::uint8_t> bytes = json::to_cbor(stored);
  record.state.resize(bytes.size());
  std::memcpy(record.state.data(), bytes.data(), bytes.size());
  return record;
}

std::optional<LiveState> live_state(const MapReader& map) {
  const std::optional<CheckpointRecord> record = map.checkpoint(kLiveState);
  if (!record) return std::nullopt;
  try {
    return state_of(*record);
  } catch (const json::exception& error) {
    throw InputError("the state of a live map cannot be read", error.what(), kRestoreMap);
  }
}

void continue_map(const std::filesystem::path& map, LiveOptions& options) {
  const MapReader reader(map);
  const std::optional<LiveState> state = live_state(reader);
  if (!state) {
    throw InputError("the map is not of a live drive", map.string(),
                     "resume it with its drive, or choose another output");
  }
  for (const FrameRecord& frame : reader.stored_frames()) options.first_frame = frame.index + 1;
  options.origin = map_origin(reader.meta());
  options.world_origin = state->world_origin;
  options.image_delays = state->image_delays;
}

EarlierScans::EarlierScans(const MapReader& map, const LiveState& state) {
  std::map<int, int> submap_of_frame;
  for (const FrameRecord& frame : map.stored_frames()) submap_of_frame[frame.index] = frame.submap;
  int submap = -1;
  map.for_each_keyframe([&](const KeyframeRecord& keyframe) {
    const auto found = submap_of_frame.find(keyframe.frame);
    if (keyframe.sensor != 0 || found == submap_of_frame.end() || found->second == submap) return;
    submap = found->second;
    scans_[keyframe.frame].position = voxel_thinned(returns_of(keyframe), kVoxel);
  });
  for (const TargetScan& target : state.targets) {
    scans_[target.frame].position = target.points_lidar;
  }
}

std::optional<PointCloud> EarlierScans::find(int frame) const {
  const auto found = scans_.find(frame);
  if (found == scans_.end() || found->second.empty()) return std::nullopt;
  return found->second;
}

}  // namespace fovea
