#include "fovea/merging/alignment.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "fovea/mapping/fusion/place_match.h"
#include "fovea/mapping/fusion/plan_view.h"
#include "fovea/mapping/fusion/pose_graph.h"

namespace fovea {
namespace {

constexpr double kRadius = 50;  // m around a submap's middle, that are registered
/// Fewer points of one map where the other one has some are no meeting.
constexpr std::size_t kMinPoints = 500;
/// Standard deviations of a registration, and of the motion from one submap to the next: rad, m.
const Twist kRegistrationSigma{0.001, 0.001, 0.001, 0.02, 0.02, 0.02};
const Twist kNextSigma{0.0005, 0.0005, 0.0005, 0.02, 0.02, 0.02};

RegistrationOptions registration_options() {
  RegistrationOptions options;
  options.max_distance = 0.5;
  options.robust_width = 0.1;
  return options;
}

/// Position of the middle frame of each submap; nothing for one without frames.
std::vector<std::optional<Eigen::Vector3d>> middles(const std::vector<FrameRecord>& frames,
                                                    std::size_t submaps) {
  std::vector<std::vector<Eigen::Vector3d>> positions(submaps);
  for (const FrameRecord& frame : frames) {
    if (frame.submap < 0 || std::size_t(frame.submap) >= submaps) continue;
    positions[std::size_t(frame.submap)].push_back(frame.T_local_lidar.translation());
  }
  std::vector<std::optional<Eigen::Vector3d>> middles(submaps);
  for (std::size_t id = 0; id < submaps; ++id) {
    if (!positions[id].empty()) middles[id] = positions[id][positions[id].size() / 2];
  }
  return middles;
}

/// Registers what B has of one of its submaps around a place to what A has there.
/// @return T_a_b of the local frames by this submap alone
std::optional<RigidMotion> match_submap(MapSurfaces& a, MapSurfaces& b, std::size_t submap,
                                        const Eigen::Vector3d& center_b,
                                        const RigidMotion& guess_T_a_b, MapAlignment& account) {
  // Both relative to the same place, in the axes of their local frames.
  const RigidMotion T_b_place(Eigen::Translation3d{center_b});
  const RigidMotion T_a_place(Eigen::Translation3d{guess_T_a_b * center_b});
  const std::vector<Eigen::Vector3f> points_a =
      a.points_near(T_a_place.translation(), kRadius + kPlaceReach);
  const std::vector<Eigen::Vector3f> points_b = b.points_near(center_b, kRadius, submap);
  const PlanView plan(points_a);
  const RigidMotion guess = T_a_place.inverse() * guess_T_a_b * T_b_place;
  if (plan.covered(points_b, guess, kPlaceReach).size() < kMinPoints) return std::nullopt;
  ++account.met;
  const RegistrationOptions options = registration_options();
  const RegistrationCloud target = prepare_cloud(points_a, options, MapSurfaces::kVoxel);
  const PointIndex index(target.points, MapSurfaces::kVoxel);
  RigidMotion T_target_source = guess;
  for (int pass = 0; pass < 2; ++pass) {  // what both have shows once they lie right
    const RegistrationCloud source = prepare_cloud(
        plan.covered(points_b, T_target_source, kPlaceReach), options, MapSurfaces::kVoxel);
    const auto match = match_place(target, index, source, T_target_source, options);
    if (!match) return std::nullopt;
    T_target_source = match->T_target_source;
  }
  if ((guess.inverse() * T_target_source).translation().norm() > kPlaceReach) return std::nullopt;
  ++account.registered;
  return T_a_place * T_target_source * T_b_place.inverse();
}

/// Pairs of submaps that the drive itself ties together: neighbours, and places it came back to.
std::vector<std::pair<std::size_t, std::size_t>> ties(const std::vector<FrameRecord>& frames,
                                                      std::size_t submaps) {
  std::vector<std::pair<std::size_t, std::size_t>> ties;
  for (std::size_t id = 1; id < submaps; ++id) ties.emplace_back(id - 1, id);
  for (const FrameRecord& frame : frames) {
    if (!frame.revisit || frame.submap < 0 || frame.revisit->submap < 0) continue;
    const auto from = std::size_t(frame.revisit->submap), to = std::size_t(frame.submap);
    if (from < to && to < submaps) ties.emplace_back(from, to);
  }
  std::sort(ties.begin(), ties.end());
  ties.erase(std::unique(ties.begin(), ties.end()), ties.end());
  return ties;
}

}  // namespace

MapAlignment align_maps(MapSurfaces& a, MapSurfaces& b, const std::vector<FrameRecord>& frames_b,
                        const RigidMotion& guess_T_a_b) {
  const std::vector<RigidMotion>& T_b_submap = b.T_local_submap();
  const auto middle_b = middles(frames_b, T_b_submap.size());
  MapAlignment alignment;
  std::vector<std::optional<RigidMotion>> T_a_b(T_b_submap.size());
  std::vector<double> moved;
  RigidMotion latest_T_a_b = guess_T_a_b;  // what one submap has found is the next one's guess
  for (std::size_t id = 0; id < T_b_submap.size(); ++id) {
    if (!middle_b[id]) continue;
    T_a_b[id] = match_submap(a, b, id, *middle_b[id], latest_T_a_b, alignment);
    if (!T_a_b[id]) continue;
    latest_T_a_b = *T_a_b[id];
    moved.push_back((latest_T_a_b * *middle_b[id] - guess_T_a_b * *middle_b[id]).norm());
  }

  const auto first = std::find_if(T_a_b.begin(), T_a_b.end(), [](const auto& T) { return T; });
  RigidMotion T_a_b_before = first == T_a_b.end() ? guess_T_a_b : **first;
  PoseGraph graph;
  for (std::size_t id = 0; id < T_b_submap.size(); ++id) {
    T_a_b_before = T_a_b[id].value_or(T_a_b_before);
    graph.add_node(T_a_b_before * T_b_submap[id]);
  }
  alignment.T_a_submap = graph.poses();
  if (moved.empty()) return alignment;  // nothing to bend it by
  for (const auto& [from, to] : ties(frames_b, T_b_submap.size())) {
    graph.add(RelativePose{from, to, T_b_submap[from].inverse() * T_b_submap[to], kNextSigma});
  }
  for (std::size_t id = 0; id < T_b_submap.size(); ++id) {
    if (!T_a_b[id]) continue;
    graph.add(AbsolutePose{id, *T_a_b[id] * T_b_submap[id], kRegistrationSigma, /*robust=*/true});
  }
  graph.optimize();
  alignment.T_a_submap = graph.poses();
  std::nth_element(moved.begin(), moved.begin() + std::ptrdiff_t(moved.size() / 2), moved.end());
  alignment.moved = moved[moved.size() / 2];
  return alignment;
}

}  // namespace fovea
