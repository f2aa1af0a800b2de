#include "fovea/merging/alignment.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "fovea/mapping/fusion/place_match.h"
#include "fovea/mapping/fusion/pose_graph.h"
#include "fovea/merging/common_space.h"
#include "fovea/merging/map_content.h"

namespace fovea {
namespace {

/// Standard deviations of a registration, and of the motion from one submap to the next: rad, m.
const Twist kRegistrationSigma{0.001, 0.001, 0.001, 0.02, 0.02, 0.02};
const Twist kNextSigma{0.0005, 0.0005, 0.0005, 0.02, 0.02, 0.02};

/// Registers what B has of one of its submaps around a place to what A has there.
/// @return T_a_b of the local frames by this submap alone
std::optional<RigidMotion> match_submap(MapSurfaces& a, MapSurfaces& b, std::size_t submap,
                                        const Eigen::Vector3d& center_b,
                                        const RigidMotion& guess_T_a_b, MapAlignment& account) {
  // Both relative to the same place, in the axes of their local frames.
  const RigidMotion T_b_place(Eigen::Translation3d{center_b});
  const Eigen::Vector3d center_a = guess_T_a_b * center_b;
  const RigidMotion T_a_place(Eigen::Translation3d{center_a});
  std::vector<Eigen::Vector3f> points_a = a.points_near(center_a, kSubmapRadius + kPlaceReach);
  const std::vector<Eigen::Vector3f> points_b = b.points_near(center_b, kSubmapRadius, submap);
  const RigidMotion guess = T_a_place.inverse() * guess_T_a_b * T_b_place;
  if (!has_common_space(PlanView(points_a), points_b, guess)) return std::nullopt;
  ++account.met;
  const PlaceTarget target(std::move(points_a), center_a);
  const auto fit = fit_common_space(target, points_b, guess);
  if (!fit) return std::nullopt;
  ++account.registered;
  return T_a_place * fit->registration.T_target_source * T_b_place.inverse();
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
  const auto middle_b = submap_middles(frames_b, T_b_submap.size());
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
