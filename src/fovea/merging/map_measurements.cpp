#include "fovea/merging/map_measurements.h"

#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "fovea/mapping/fusion/navigation_check.h"
#include "fovea/mapping/fusion/submap_errors.h"

namespace fovea {
namespace {

/// Standard deviation of navigation as NavigationCheck has it: 0 where the drive states none.
double stated_accuracy(const FrameRecord& frame) {
  const auto stated = frame.figures.find("navigation_accuracy");
  if (stated == frame.figures.end()) return 0;
  return std::isfinite(stated->second) ? stated->second : std::numeric_limits<double>::infinity();
}

/// Odometry from submap to submap.
void add_motion(const MapContent& map, std::size_t first, PoseGraph& graph) {
  struct Start {
    RigidMotion T_odom_submap;
    double path = 0;
  };
  std::map<std::size_t, Start> starts;
  std::optional<RigidMotion> last;
  double path = 0;
  int weak = 0;
  bool restarted = false;
  std::optional<std::size_t> before;
  for (const FrameRecord& frame : map.frames) {
    if (frame.submap < 0) continue;
    const auto id = static_cast<std::size_t>(frame.submap);
    restarted = restarted || frame.has("track_restarted") || frame.has("pose_unknown");
    if (last) path += (frame.T_odom_lidar.translation() - last->translation()).norm();
    last = frame.T_odom_lidar;
    if (frame.has("registration_degenerate") || frame.has("registration_failed")) ++weak;
    if (starts.contains(id)) continue;
    const RigidMotion T_submap_lidar = map.T_local_submap.at(id).inverse() * frame.T_local_lidar;
    starts[id] = {frame.T_odom_lidar * T_submap_lidar.inverse(), path};
    if (before) {
      const Start& start = starts[*before];
      graph.add(RelativePose{
          first + *before, first + id, start.T_odom_submap.inverse() * starts[id].T_odom_submap,
          restarted ? restart_deviations() : odometry_deviations(path - start.path, weak)});
    }
    before = id;
    weak = 0;
    restarted = false;
  }
}

/// Ties a submap without frames to its neighbor, as the map has them.
void add_empty_submaps(const MapContent& map, std::size_t first, PoseGraph& graph) {
  std::vector<bool> has_frame(map.T_local_submap.size());
  for (const FrameRecord& frame : map.frames) {
    if (frame.submap >= 0) has_frame[std::size_t(frame.submap)] = true;
  }
  for (std::size_t id = 1; id < has_frame.size(); ++id) {
    const bool is_beside_empty_first = id == 1 && !has_frame[0];
    if (has_frame[id] && !is_beside_empty_first) continue;
    const RigidMotion T = map.T_local_submap[id - 1].inverse() * map.T_local_submap[id];
    graph.add(RelativePose{first + id - 1, first + id, T,
                           odometry_deviations(T.translation().norm(), 0)});
  }
}

/// Places to which the drive came back.
void add_loops(const MapContent& map, std::size_t first, PoseGraph& graph) {
  for (const FrameRecord& frame : map.frames) {
    if (!frame.revisit || frame.submap < 0 || frame.revisit->submap < 0) continue;
    const auto from = static_cast<std::size_t>(frame.revisit->submap),
               to = static_cast<std::size_t>(frame.submap);
    if (from >= to || to >= map.T_local_submap.size()) continue;
    const RigidMotion T_to_lidar = map.T_local_submap[to].inverse() * frame.T_local_lidar;
    graph.add(RelativePose{first + from, first + to,
                           frame.revisit->T_submap_lidar * T_to_lidar.inverse(), loop_deviations(),
                           /*robust=*/true});
  }
}

void add_navigation(const MapContent& map, std::size_t first, const RigidMotion& T_city_local,
                    PoseGraph& graph) {
  std::vector<StampedPose> poses;
  std::vector<double> accuracy;
  for (const FrameRecord& frame : map.frames) {
    if (!frame.T_local_lidar_navigation || !frame.stamp) continue;
    if (!poses.empty() && *frame.stamp <= poses.back().time) continue;
    poses.push_back({*frame.stamp, *frame.T_local_lidar_navigation});
    accuracy.push_back(stated_accuracy(frame));
  }
  if (poses.empty()) return;
  const Trajectory navigation(std::move(poses));
  NavigationCheck check(&navigation, accuracy);
  int latest = -1;
  for (const FrameRecord& frame : map.frames) {
    if (frame.submap < 0 || !frame.stamp) continue;
    if (frame.has("track_restarted")) check.restart();
    check.observe(*frame.stamp, frame.T_odom_lidar);
    if (frame.submap == latest) continue;
    latest = frame.submap;
    const auto id = static_cast<std::size_t>(frame.submap);
    auto measured = check.measurement(first + id, *frame.stamp);
    if (!measured) continue;
    const RigidMotion T_submap_lidar = map.T_local_submap.at(id).inverse() * frame.T_local_lidar;
    measured->T_local_node = T_city_local * measured->T_local_node * T_submap_lidar.inverse();
    graph.add(*measured);
  }
}

}  // namespace

void add_map_measurements(const MapContent& map, std::size_t first, const RigidMotion& T_city_local,
                          PoseGraph& graph) {
  add_motion(map, first, graph);
  add_empty_submaps(map, first, graph);
  add_loops(map, first, graph);
  add_navigation(map, first, T_city_local, graph);
}

}  // namespace fovea
