#include "fovea/evaluation/protocol.h"

#include <set>

#include "fovea/errors.h"

namespace fovea {
namespace {

/// The map's refined poses over time; empty where the frames have no usable stamps.
std::optional<Trajectory> refined_trajectory(const ScoredMap& map, const FrameSource& drive) {
  std::vector<StampedPose> poses;
  for (const FrameRecord& record : map.frames) {
    const std::optional<TimeNs> stamp = record.stamp ? record.stamp : drive.stamp(record.index);
    if (record.status == FrameStatus::kSkipped || !stamp) continue;
    if (!poses.empty() && *stamp <= poses.back().time) return std::nullopt;
    poses.push_back({*stamp, record.T_local_lidar});
  }
  if (poses.size() < 2) return std::nullopt;
  return Trajectory(std::move(poses));
}

/// The motion during the sweep around the frame's stamp. The set must not depend on whether the
/// map's maker knew it: without it points would lie up to half a sweep's motion off.
std::optional<SweepMotion> sweep_motion(const FrameRecord& record, const FrameSource& drive,
                                        const std::optional<Trajectory>& refined) {
  if (record.motion) return record.motion;
  const std::optional<TimeNs> stamp = record.stamp ? record.stamp : drive.stamp(record.index);
  if (!refined || !stamp) return std::nullopt;
  const SweepTiming& sweep = drive.info().sweep;
  const auto begin = refined->at(*stamp + from_seconds(sweep.start_time()));
  const auto end = refined->at(*stamp + from_seconds(sweep.end_time()));
  if (!begin || !end) return std::nullopt;
  return SweepMotion{velocity_between(*begin, *end, sweep.period)};
}

/// Whether the protocol scores this frame. InputError if it was mapped and must not have been.
bool is_scored(const FrameRecord& record, const ScoredMap& map, const ProtocolOptions& options) {
  if (record.status == FrameStatus::kSkipped) return false;
  const bool named = options.hold_out.contains(record.index);
  if (!scores_held_out(options.protocol)) {
    return record.status == FrameStatus::kMapped && !named;
  }
  if (!map.statuses_known) return named;
  if (named && record.status == FrameStatus::kMapped) {
    throw InputError("the map was built with a frame to be scored as held out",
                     "frame " + std::to_string(record.index),
                     "map the drive anew with --hold-out " + options.hold_out.spec());
  }
  return record.status == FrameStatus::kHeldOut && (named || options.hold_out.none());
}

void require_nothing_of(const std::vector<PlacedFrame>& frames, const PointCloud& points) {
  if (points.frame.empty()) return;
  std::set<int> held_out;
  for (const PlacedFrame& placed : frames) held_out.insert(placed.index);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.camera[i] != kNoCamera && held_out.contains(points.frame[i])) {
      throw InputError("the map has points of a frame to be scored as held out",
                       "frame " + std::to_string(points.frame[i]),
                       "score frames that were held out when the map was built");
    }
  }
}

[[noreturn]] void reject_empty_selection(const ProtocolOptions& options) {
  const bool held_out = scores_held_out(options.protocol);
  throw InputError(held_out ? "the map held out no frame" : "the map has no frame to score",
                   std::string("protocol ") + to_string(options.protocol),
                   held_out ? "build it with --hold-out, or choose another protocol"
                            : "check that the map and --hold-out leave any");
}

}  // namespace

bool scores_held_out(Protocol protocol) {
  return protocol == Protocol::kHeldOut || protocol == Protocol::kCrossCamera;
}

const char* to_string(Protocol protocol) {
  switch (protocol) {
    case Protocol::kInSample:
      return "in-sample";
    case Protocol::kInSampleNavigation:
      return "in-sample-nav";
    case Protocol::kHeldOut:
      return "held-out";
    case Protocol::kCrossCamera:
      return "cross-camera";
  }
  return "unknown";
}

Protocol parse_protocol(std::string_view name) {
  for (const Protocol protocol : {Protocol::kInSample, Protocol::kInSampleNavigation,
                                  Protocol::kHeldOut, Protocol::kCrossCamera}) {
    if (name == to_string(protocol)) return protocol;
  }
  throw ConfigError("there is no protocol \"" + std::string(name) + "\"", "--protocol",
                    "use in-sample, in-sample-nav, held-out or cross-camera");
}

const char* explanation(Protocol protocol) {
  switch (protocol) {
    case Protocol::kInSample:
      return "In-sample, as in the paper: the scans that built the map also score it, so a map "
             "that "
             "keeps every point scores ME = TE = 0. It says how much filtering removed, never how "
             "good the map is; held-out figures do.";
    case Protocol::kInSampleNavigation:
      return "In-sample, as in the paper, the scans that built the map placed by the navigation's "
             "poses: position errors mix the map's with the navigation's. It is no measure of "
             "quality; held-out figures are.";
    case Protocol::kHeldOut:
      return "Held-out: the scans scored added no point and no colour to the map. No single figure "
             "tells its quality: coverage, free-space violations and sharpness belong to ME and "
             "TE.";
    case Protocol::kCrossCamera:
      return "Cross-camera: the scans scored added no point and no colour to the map, and the "
             "cameras scored coloured none of it: what two cameras disagree on counts as error.";
  }
  return "";
}

std::vector<PlacedFrame> select_frames(const ScoredMap& map, const FrameSource& drive,
                                       const ProtocolOptions& options) {
  const bool held_out = scores_held_out(options.protocol);
  if (held_out && !map.statuses_known && options.hold_out.none()) {
    throw InputError("a point cloud does not say which frames were held out",
                     std::string("protocol ") + to_string(options.protocol),
                     "name them with --hold-out");
  }
  const std::optional<Trajectory> refined = refined_trajectory(map, drive);
  const bool by_navigation = options.protocol == Protocol::kInSampleNavigation;
  bool any_scored = false;
  std::vector<PlacedFrame> selected;
  for (const FrameRecord& record : map.frames) {
    if (!is_scored(record, map, options)) continue;
    any_scored = true;
    if (by_navigation && !record.T_local_lidar_navigation) continue;
    selected.push_back({record.index,
                        by_navigation ? *record.T_local_lidar_navigation : record.T_local_lidar,
                        sweep_motion(record, drive, refined)});
  }
  if (!any_scored) reject_empty_selection(options);
  if (selected.empty()) {
    throw InputError("the map has no navigation poses", "protocol in-sample-nav",
                     "use the protocol in-sample");
  }
  if (held_out) require_nothing_of(selected, map.points_local);
  return selected;
}

std::vector<std::size_t> select_cameras(const ScoredMap& map, const DriveInfo& drive,
                                        const ProtocolOptions& options) {
  const std::vector<Camera>& available = drive.calibration.cameras;
  std::vector<int> wanted = options.cameras.empty() ? map.cameras : options.cameras;
  if (wanted.empty()) {
    for (const Camera& camera : available) wanted.push_back(camera.index);
  }
  std::vector<std::size_t> selected;
  for (const int number : wanted) {
    const auto found = std::find_if(available.begin(), available.end(),
                                    [&](const Camera& c) { return c.index == number; });
    if (found == available.end()) {
      throw ConfigError("the drive was not opened with a camera to be scored",
                        "camera " + std::to_string(number), "open it with all scored cameras");
    }
    if (options.protocol == Protocol::kCrossCamera &&
        std::find(map.cameras.begin(), map.cameras.end(), number) != map.cameras.end()) {
      throw ConfigError("a camera to be scored cross-camera has coloured the map",
                        "camera " + std::to_string(number), "choose another one with --cameras");
    }
    const auto place = static_cast<std::size_t>(found - available.begin());
    if (std::find(selected.begin(), selected.end(), place) == selected.end()) {
      selected.push_back(place);
    }
  }
  return selected;
}

}  // namespace fovea
