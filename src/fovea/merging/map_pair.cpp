#include "fovea/merging/map_pair.h"

#include <algorithm>

#include "fovea/core/median.h"
#include "fovea/errors.h"
#include "fovea/map/map_meta.h"
#include "fovea/merging/map_gain.h"
#include "fovea/merging/shift_search.h"

namespace fovea {
namespace {

/// A match that places B this far (m) from the median of the matches of near submaps is wrong.
constexpr double kConsistent = 2;
constexpr std::size_t kNear = 5;  // submaps of B
/// Least share of consistent matches in the tried pairs.
constexpr double kLeastShare = 0.1;
constexpr std::size_t kShifts = 4, kSearchedPlaces = 3;
constexpr double kSearchRadius = 50;  // m

/// How far matches move the middles of B's submaps from the stated places, in A's local frame.
std::vector<Eigen::Vector3d> moves_of(const std::vector<SubmapMatch>& matches, const MapContent& a,
                                      const MapContent& b, const RigidMotion& stated_T_a_b) {
  const auto middles = submap_middles(b.frames, b.T_local_submap.size());
  std::vector<Eigen::Vector3d> moves;
  for (const SubmapMatch& match : matches) {
    const RigidMotion T_a_b =
        a.T_local_submap[match.submap_a] * match.T_a_b * b.T_local_submap[match.submap_b].inverse();
    const Eigen::Vector3d middle = middles[match.submap_b].value();
    moves.push_back(T_a_b * middle - stated_T_a_b * middle);
  }
  return moves;
}

Eigen::Vector3d median_of_each(const std::vector<Eigen::Vector3d>& moves) {
  Eigen::Vector3d median;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(moves.size());
    for (const Eigen::Vector3d& move : moves) values.push_back(move[axis]);
    median[axis] = median_of(std::move(values));
  }
  return median;
}

/// Leaves out the matches that contradict most of the others near them.
void keep_consistent(const MapContent& a, const MapContent& b, const RigidMotion& stated_T_a_b,
                     std::vector<SubmapMatch>& matches) {
  const std::vector<Eigen::Vector3d> moves = moves_of(matches, a, b, stated_T_a_b);
  std::vector<SubmapMatch> kept;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    std::vector<Eigen::Vector3d> near;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const auto [low, high] = std::minmax(matches[i].submap_b, matches[k].submap_b);
      if (high - low <= kNear) near.push_back(moves[i]);
    }
    if ((moves[k] - median_of_each(near)).norm() < kConsistent) kept.push_back(matches[k]);
  }
  matches = std::move(kept);
}

/// Aligns two maps from where they are said to lie.
class Aligner {
 public:
  Aligner(const MapReader& a, const MapReader& b, const MapContent& content_a,
          const MapContent& content_b, const RigidMotion& stated_T_a_b)
      : scans_a_(a, content_a),
        scans_b_(b, content_b),
        content_a_(content_a),
        content_b_(content_b),
        stated_T_a_b_(stated_T_a_b) {}

  /// @return consistent matches, the most that any guess gives
  SubmapMatches run() {
    SubmapMatches best = matched(stated_T_a_b_);
    if (best.tried == 0 || is_enough(best)) return best;
    for (const Eigen::Vector2d& shift : shifts()) {
      const Eigen::Translation3d by(shift.x(), shift.y(), 0);
      SubmapMatches other = matched(by * stated_T_a_b_);
      if (other.matches.size() > best.matches.size()) best = std::move(other);
    }
    return best;
  }

  static bool is_enough(const SubmapMatches& result) {
    return double(result.matches.size()) > kLeastShare * double(result.tried);
  }

 private:
  SubmapMatches matched(const RigidMotion& guess_T_a_b) {
    SubmapMatches result = match_submaps(scans_a_, content_a_, scans_b_, content_b_, guess_T_a_b);
    if (!result.matches.empty()) {
      keep_consistent(content_a_, content_b_, stated_T_a_b_, result.matches);
    }
    return result;
  }

  /// Likely shifts of B at some places where A is near.
  std::vector<Eigen::Vector2d> shifts() {
    const auto middles_a = submap_middles(content_a_.frames, content_a_.T_local_submap.size());
    const auto middles_b = submap_middles(content_b_.frames, content_b_.T_local_submap.size());
    std::vector<Eigen::Vector3d> places_b;
    for (const auto& middle_b : middles_b) {
      const bool is_near =
          middle_b && std::any_of(middles_a.begin(), middles_a.end(), [&](const auto& middle_a) {
            return middle_a && (stated_T_a_b_ * *middle_b - *middle_a).norm() < kSearchRadius;
          });
      if (is_near) places_b.push_back(*middle_b);
    }
    std::vector<Eigen::Vector2d> all;
    for (std::size_t k = 0; k < std::min(kSearchedPlaces, places_b.size()); ++k) {
      const Eigen::Vector3d& place_b = places_b[(2 * k + 1) * places_b.size() /
                                                (2 * std::min(kSearchedPlaces, places_b.size()))];
      std::vector<Eigen::Vector3f> points_b = scans_b_.points_near(place_b, kSearchRadius);
      const Eigen::Matrix3f R = stated_T_a_b_.linear().cast<float>();
      for (Eigen::Vector3f& p : points_b) p = R * p;
      const auto shifts =
          likely_shifts(scans_a_.points_near(stated_T_a_b_ * place_b, kSearchRadius + kShiftReach),
                        points_b, kShifts);
      all.insert(all.end(), shifts.begin(), shifts.end());
    }
    return all;
  }

  SubmapScans scans_a_, scans_b_;
  const MapContent &content_a_, &content_b_;
  RigidMotion stated_T_a_b_;
};

}  // namespace

MapName name_of(const MapReader& map, const MapContent& content) {
  return {content.is_merged ? map.identity() : content.drives.front().digest,
          content.drives.front().name, content.T_local_submap.size()};
}

const char* to_string(PairVerdict verdict) {
  switch (verdict) {
    case PairVerdict::kFits:
      return "fits";
    case PairVerdict::kNoOverlap:
      return "no overlap";
    case PairVerdict::kNoFit:
      break;
  }
  return "no fit";
}

MapPair align_pair(const MapReader& a, const MapReader& b) {
  const auto held_a = a.hold_state(), held_b = b.hold_state();
  const MapContent content_a(a), content_b(b);
  require_one_drive(content_a, content_a.drives.front().name);
  require_one_drive(content_b, content_b.drives.front().name);
  MapPair pair;
  pair.a = name_of(a, content_a);
  pair.b = name_of(b, content_b);
  const auto stated = stated_T_a_b(content_a, content_b);
  if (!stated) {
    throw InputError("a map without georeference: nothing says how the two lie to each other",
                     content_b.drives.front().name,
                     "map drives with GPS/INS, or give a drive its origin (docs/drives.md)");
  }
  SubmapMatches found = Aligner(a, b, content_a, content_b, *stated).run();
  pair.tried = found.tried;
  if (found.tried == 0) return pair;
  if (found.matches.empty() || !Aligner::is_enough(found)) {
    pair.verdict = PairVerdict::kNoFit;
    return pair;
  }
  pair.verdict = PairVerdict::kFits;
  pair.matches = std::move(found.matches);
  pair.moved = median_of_each(moves_of(pair.matches, content_a, content_b, *stated)).norm();
  set_gains(a, b, pair.matches);
  return pair;
}

}  // namespace fovea
