#include "fovea/pipeline/live_state.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>

#include "fovea/errors.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/map/keyframe_returns.h"
#include "fovea/map/map_meta.h"

namespace fovea {
namespace {

using nlohmann::json;

constexpr float kVoxel = 0.5;  // m, of scans for loop closures: memory grows by 50 kB a submap

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

/// The state as bytes: length of the header (8 bytes), header (JSON), points of the targets
/// (float).
using Bytes = std::vector<std::byte>;
using HeaderSize = std::uint64_t;

void append(Bytes& bytes, const void* data, std::size_t size) {
  const auto* begin = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), begin, begin + size);
}

double finite(const json& value) {
  const auto number = value.get<double>();
  if (!std::isfinite(number)) throw std::invalid_argument("a number is not finite");
  return number;
}

/// Takes bytes from the beginning.
std::span<const std::byte> take(std::span<const std::byte>& bytes, std::size_t size) {
  if (size > bytes.size()) throw std::invalid_argument("it ends early");
  const auto taken = bytes.first(size);
  bytes = bytes.subspan(size);
  return taken;
}

std::vector<Eigen::Vector3f> take_points(std::span<const std::byte>& bytes, std::size_t count) {
  if (count > bytes.size()) throw std::invalid_argument("it ends early");
  const auto taken = take(bytes, count * sizeof(Eigen::Vector3f));
  std::vector<Eigen::Vector3f> points(count);
  if (count > 0) std::memcpy(points.front().data(), taken.data(), taken.size());
  const auto is_finite = [](const Eigen::Vector3f& p) { return p.allFinite(); };
  if (!std::all_of(points.begin(), points.end(), is_finite)) {
    throw std::invalid_argument("a point is not finite");
  }
  return points;
}

LiveState state_of(const CheckpointRecord& record) {
  std::span<const std::byte> bytes = record.state;
  HeaderSize size = 0;
  std::memcpy(&size, take(bytes, sizeof(size)).data(), sizeof(size));
  const auto text = take(bytes, size);
  const json header = json::parse(reinterpret_cast<const char*>(text.data()),
                                  reinterpret_cast<const char*>(text.data() + text.size()));
  LiveState state;
  for (const json& camera : header.at("cameras")) {
    state.image_delays[camera.at("number").get<int>()] = finite(camera.at("delay"));
  }
  if (header.contains("world_origin")) {
    const json& origin = header.at("world_origin");
    state.world_origin =
        Eigen::Vector3d(finite(origin.at(0)), finite(origin.at(1)), finite(origin.at(2)));
  }
  for (const json& target : header.at("targets")) {
    state.targets.push_back({target.at("frame").get<int>(),
                             take_points(bytes, target.at("points").get<std::size_t>())});
  }
  return state;
}

}  // namespace

CheckpointRecord checkpoint_of(const LiveState& state, int last_frame) {
  json header = {{"cameras", json::array()}, {"targets", json::array()}};
  for (const auto& [number, delay] : state.image_delays) {
    header["cameras"].push_back({{"number", number}, {"delay", delay}});
  }
  if (state.world_origin) {
    header["world_origin"] = {state.world_origin->x(), state.world_origin->y(),
                              state.world_origin->z()};
  }
  for (const TargetScan& target : state.targets) {
    header["targets"].push_back({{"frame", target.frame}, {"points", target.points_lidar.size()}});
  }
  const std::string text = header.dump();
  const HeaderSize size = text.size();
  CheckpointRecord record{last_frame, {}};
  append(record.state, &size, sizeof(size));
  append(record.state, text.data(), text.size());
  for (const TargetScan& target : state.targets) {
    if (target.points_lidar.empty()) continue;
    append(record.state, target.points_lidar.front().data(),
           target.points_lidar.size() * sizeof(Eigen::Vector3f));
  }
  return record;
}

LiveState live_state(const CheckpointRecord& record) {
  try {
    return state_of(record);
  } catch (const json::exception& error) {
    throw InputError("the state of a live map cannot be read", error.what(), kRestoreMap);
  } catch (const std::invalid_argument& error) {
    throw InputError("the state of a live map cannot be read", error.what(), kRestoreMap);
  }
}

std::optional<LiveState> live_state(const MapReader& map) {
  const std::optional<CheckpointRecord> record = map.checkpoint(kLiveState);
  if (!record) return std::nullopt;
  return live_state(*record);
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
