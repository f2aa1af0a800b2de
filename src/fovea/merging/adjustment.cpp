#include "fovea/merging/adjustment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "fovea/core/median.h"
#include "fovea/errors.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/mapping/fusion/pose_graph.h"
#include "fovea/merging/city_gains.h"
#include "fovea/merging/georeference.h"
#include "fovea/merging/map_measurements.h"
#include "fovea/merging/twist_adjoint.h"

namespace fovea {
namespace {

/// Standard deviations of poses that stay as they are.
constexpr double kFixed = 1e-6;  // rad, m
/// A match is wrong if it places a submap farther from the solution than all of these: m, rad, and
/// standard deviations.
constexpr double kWrongDistance = 0.15, kWrongRotation = 0.01, kWrongSigmas = 6;

/// A match between two nodes of the graph.
struct Tie {
  const MapPair* pair;
  const SubmapMatch* match;
  std::size_t node_a, node_b;
  RelativePose measured;  ///< from the earlier node
};

class Adjustment {
 public:
  explicit Adjustment(const AdjustmentJob& job);
  CityPoses run();

 private:
  std::size_t node(std::size_t map, std::size_t submap) const { return first_[map] + submap; }
  std::size_t map_of(const std::string& identity, const char* of_what) const;
  RigidMotion T_city_local(const AdjustedMap& map) const;
  const PlacedMap* fixed(std::size_t map) const;

  void add_nodes();
  void add_ties();
  std::vector<RigidMotion> solved(const std::vector<RigidMotion>& poses) const;
  void reject_wrong_ties(const std::vector<RigidMotion>& poses, CityPoses& city);
  std::vector<Eigen::Vector3d> gains() const;  // of the nodes
  CityPoses result(const std::vector<RigidMotion>& poses) const;
  std::size_t map_named(const SurveyedPoint& point) const;
  /// The submap that shows a surveyed point, as a node, and the point in it.
  PointPosition position_of(const SurveyedPoint& point) const;

  const AdjustmentJob& job_;
  RigidMotion T_ecef_city_;         // axes of the first map's local frame
  std::vector<std::size_t> first_;  // node of the first submap of each map
  std::vector<RigidMotion> start_;  // T_city_submap by the maps, or by the fixed poses
  std::vector<Tie> ties_;
  std::vector<PointPosition> positions_;  // of the surveyed points
};

Adjustment::Adjustment(const AdjustmentJob& job) : job_(job) {
  if (job.maps.empty()) throw InputError("no maps to adjust", "the command", "give two or more");
  T_ecef_city_ = T_ecef_enu(origin_of(job.maps.front().content));
  std::set<std::string> identities;
  for (const AdjustedMap& map : job.maps) {
    if (!identities.insert(map.name.identity).second) {
      throw InputError("a map is given twice", map.name.drive, "give each map once");
    }
    require_one_drive(map.content, map.name.drive);
    require_same_coordinates(job.maps.front().content, map.content);
    if (!job.points.empty()) require_ellipsoidal_wgs84(map.content);
  }
  for (const PlacedMap& placed : job.fixed) {
    if (placed.submaps.size() !=
        job.maps[map_of(placed.name.identity, "the fixed poses")].name.submaps) {
      throw InputError("fixed poses have other submaps than the map", placed.name.drive,
                       "give the poses of this map");
    }
  }
  add_nodes();
  add_ties();
  for (const SurveyedPoint& point : job.points) positions_.push_back(position_of(point));
}

std::size_t Adjustment::map_of(const std::string& identity, const char* of_what) const {
  for (std::size_t k = 0; k < job_.maps.size(); ++k) {
    if (job_.maps[k].name.identity == identity) return k;
  }
  throw InputError(fmt::format("{} are of a map that is not given", of_what), identity,
                   "give this map, too, or make the file again for the maps given");
}

RigidMotion Adjustment::T_city_local(const AdjustedMap& map) const {
  return T_ecef_city_.inverse() * T_ecef_enu(origin_of(map.content));
}

const PlacedMap* Adjustment::fixed(std::size_t map) const {
  for (const PlacedMap& placed : job_.fixed) {
    if (placed.name.identity == job_.maps[map].name.identity) return &placed;
  }
  return nullptr;
}

void Adjustment::add_nodes() {
  for (std::size_t k = 0; k < job_.maps.size(); ++k) {
    first_.push_back(start_.size());
    const RigidMotion T_city_local = this->T_city_local(job_.maps[k]);
    const PlacedMap* placed = fixed(k);
    for (std::size_t id = 0; id < job_.maps[k].content.T_local_submap.size(); ++id) {
      start_.push_back(placed != nullptr
                           ? T_ecef_city_.inverse() * placed->submaps[id].T_ecef_submap
                           : T_city_local * job_.maps[k].content.T_local_submap[id]);
    }
  }
}

void Adjustment::add_ties() {
  std::set<std::pair<std::size_t, std::size_t>> aligned;
  for (const MapPair& pair : job_.pairs) {
    const std::size_t a = map_of(pair.a.identity, "a pair"), b = map_of(pair.b.identity, "a pair");
    if (a == b) throw InputError("a pair has one map twice", pair.a.drive, "align two maps");
    if (pair.a.submaps != job_.maps[a].name.submaps ||
        pair.b.submaps != job_.maps[b].name.submaps) {
      throw InputError("a pair has other submaps than its maps", pair.a.drive,
                       "align the two maps again");
    }
    if (!aligned.insert(std::minmax(a, b)).second) {
      throw InputError("a pair of maps is given twice", pair.a.drive + ", " + pair.b.drive,
                       "give each pair once");
    }
    for (const SubmapMatch& match : pair.matches) {
      const std::size_t node_a = node(a, match.submap_a), node_b = node(b, match.submap_b);
      RelativePose measured{node_a, node_b, match.T_a_b, Twist::Ones(), /*robust=*/true};
      Eigen::Matrix<double, 6, 6> covariance = match.covariance;  // in the frame of b
      if (node_a > node_b) {
        measured = {node_b, node_a, match.T_a_b.inverse(), Twist::Ones(), /*robust=*/true};
        const auto to_a = adjoint(match.T_a_b);
        covariance = to_a * covariance * to_a.transpose();
      }
      measured.sigma = covariance.diagonal().cwiseSqrt();
      ties_.push_back({&pair, &match, node_a, node_b, measured});
    }
  }
}

std::size_t Adjustment::map_named(const SurveyedPoint& point) const {
  std::vector<std::size_t> by_drive, by_identity;
  for (std::size_t k = 0; k < job_.maps.size(); ++k) {
    if (job_.maps[k].name.drive == point.map) by_drive.push_back(k);
    if (job_.maps[k].name.identity.starts_with(point.map)) by_identity.push_back(k);
  }
  const std::vector<std::size_t>& named = by_drive.empty() ? by_identity : by_drive;
  if (named.size() == 1) return named.front();
  throw InputError(
      fmt::format("the point {} is of {}", point.name,
                  named.empty() ? "a map that is not given" : "a name that several maps have"),
      point.map, "name a drive of the maps, or the first digits of a map's identity");
}

PointPosition Adjustment::position_of(const SurveyedPoint& point) const {
  const std::size_t k = map_named(point);
  const MapContent& map = job_.maps[k].content;
  const auto middles = submap_middles(map.frames, map.T_local_submap.size());
  std::optional<std::size_t> nearest;
  const auto distance = [&](std::size_t id) { return (*middles[id] - point.p_local).norm(); };
  for (std::size_t id = 0; id < middles.size(); ++id) {
    if (middles[id] && (!nearest || distance(id) < distance(*nearest))) nearest = id;
  }
  if (!nearest) {
    throw InputError("a map without frames shows no surveyed point", point.map,
                     "name another map of the point");
  }
  const Eigen::Vector3d p_ecef = T_ecef_enu(point.position).translation();
  return {node(k, *nearest), map.T_local_submap[*nearest].inverse() * point.p_local,
          T_ecef_city_.inverse() * p_ecef, point.sigma};
}

std::vector<RigidMotion> Adjustment::solved(const std::vector<RigidMotion>& poses) const {
  PoseGraph graph;
  for (const RigidMotion& pose : poses) graph.add_node(pose);
  for (std::size_t k = 0; k < job_.maps.size(); ++k) {
    if (fixed(k) != nullptr) {
      for (std::size_t id = 0; id < job_.maps[k].name.submaps; ++id) {
        graph.add(AbsolutePose{node(k, id), start_[node(k, id)], Twist::Constant(kFixed)});
      }
      continue;
    }
    const AdjustedMap& map = job_.maps[k];
    add_map_measurements(map.content, first_[k], T_city_local(map), graph);
  }
  for (const Tie& tie : ties_) graph.add(tie.measured);
  for (std::size_t i = 0; i < job_.points.size(); ++i) {
    if (!job_.points[i].is_check) graph.add(positions_[i]);
  }
  graph.optimize();
  return graph.poses();
}

void Adjustment::reject_wrong_ties(const std::vector<RigidMotion>& poses, CityPoses& city) {
  std::vector<Tie> kept;
  for (const Tie& tie : ties_) {
    const RelativePose& m = tie.measured;
    const RigidMotion error = m.T_from_to.inverse() * (poses[m.from].inverse() * poses[m.to]);
    const double distance = error.translation().norm(), turn = rotation_angle(error.linear());
    const bool is_wrong =
        distance > std::max(kWrongDistance, kWrongSigmas * m.sigma.tail<3>().norm()) ||
        turn > std::max(kWrongRotation, kWrongSigmas * m.sigma.head<3>().norm());
    if (!is_wrong) {
      kept.push_back(tie);
      continue;
    }
    city.rejected.push_back({tie.pair->a.identity, tie.pair->b.identity, tie.match->submap_a,
                             tie.match->submap_b, distance});
  }
  ties_ = std::move(kept);
}

CityPoses Adjustment::run() {
  CityPoses rejected;
  std::vector<RigidMotion> poses = solved(start_);
  reject_wrong_ties(poses, rejected);
  if (!rejected.rejected.empty()) poses = solved(poses);
  CityPoses city = result(poses);
  city.origin = job_.origin.value_or(origin_of(job_.maps.front().content));
  city.rejected = std::move(rejected.rejected);
  return city;
}

std::vector<Eigen::Vector3d> Adjustment::gains() const {
  std::vector<GainTie> ties;
  for (const Tie& tie : ties_) {
    if (!tie.match->log2_gain) continue;
    ties.push_back({tie.node_a, tie.node_b, tie.match->log2_gain->cast<double>().matrix()});
  }
  std::vector<GainNode> nodes(start_.size());
  for (std::size_t k = 0; k < job_.maps.size(); ++k) {
    const PlacedMap* placed = fixed(k);
    for (std::size_t id = 0; id < job_.maps[k].name.submaps; ++id) {
      nodes[node(k, id)].continues = id > 0;
      if (placed != nullptr) nodes[node(k, id)].fixed = placed->submaps[id].log2_gain;
    }
  }
  return city_gains(nodes, ties);
}

CityPoses Adjustment::result(const std::vector<RigidMotion>& poses) const {
  CityPoses city;
  const std::vector<Eigen::Vector3d> gains = this->gains();
  for (std::size_t k = 0; k < job_.maps.size(); ++k) {
    const PlacedMap* placed = fixed(k);
    PlacedMap& map = city.maps.emplace_back();
    map.name = job_.maps[k].name;
    map.is_fixed = placed != nullptr;
    std::vector<double> moves;
    for (std::size_t id = 0; id < map.name.submaps; ++id) {
      const std::size_t n = node(k, id);
      map.submaps.push_back(placed != nullptr ? placed->submaps[id]
                                              : SubmapPlacement{T_ecef_city_ * poses[n], gains[n]});
      moves.push_back((poses[n].translation() - start_[n].translation()).norm());
    }
    map.moved = median_of(std::move(moves));
    for (const Tie& tie : ties_) {
      map.matches +=
          tie.pair->a.identity == map.name.identity || tie.pair->b.identity == map.name.identity;
    }
  }
  for (std::size_t i = 0; i < job_.points.size(); ++i) {
    const SurveyedPoint& point = job_.points[i];
    const Eigen::Vector3d shown = poses[positions_[i].node] * positions_[i].p_node;
    const RigidMotion T_enu_city = T_ecef_enu(point.position).inverse() * T_ecef_city_;
    city.points.push_back(
        {point.name, point.is_check, T_enu_city.linear() * (shown - positions_[i].p_local)});
  }
  return city;
}

}  // namespace

CityPoses adjust_city(const AdjustmentJob& job) { return Adjustment(job).run(); }

}  // namespace fovea
