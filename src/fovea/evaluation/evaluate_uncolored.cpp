#include "fovea/evaluation/evaluate_uncolored.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/errors.h"
#include "fovea/evaluation/distribution.h"
#include "fovea/evaluation/scored_frames.h"
#include "fovea/evaluation/warnings.h"
#include "fovea/geometry/kd_tree.h"

namespace fovea {
namespace {

/// A scan against the map.
struct ScanScore {
  std::optional<UnscoredFrame> unscored;
  std::vector<Eigen::Vector3f> positions;  // relative to the map's origin
  PointErrors errors;
};

class UncoloredScorer {
 public:
  UncoloredScorer(PointCloud map_local, const FrameSource& drive)
      : drive_(drive),
        points_(all_points(std::move(map_local))),
        tree_(points_.position, KdTree::kLargeLeafSize),
        free_space_(points_) {}

  ScanScore score(const PlacedFrame& placed) {
    ScanScore score;
    const auto loaded = load_scored_frame(drive_, placed.index);
    if (const auto* unscored = std::get_if<UnscoredFrame>(&loaded)) {
      score.unscored = *unscored;
      return score;
    }
    const PointCloud& measured = std::get<Frame>(loaded).scan;
    const PointCloud scan = compensated_scan(measured, placed, drive_.info());
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const float range = measured.position[i].norm();
      if (!(range > kEvaluatedNear && range < kEvaluatedFar)) continue;
      const Eigen::Vector3d p_local = placed.T_local_lidar * scan.position[i].cast<double>();
      score.positions.push_back((p_local - points_.origin).cast<float>());
      const float squared = tree_.nearest(score.positions.back()).squared_distance;
      score.errors.position.push_back(std::sqrt(squared));
    }
    free_space_.add_scan(scan, placed.T_local_lidar, /*cameras=*/{}, drive_.info().lidars);
    return score;
  }

  const ColoredPoints& points() const { return points_; }
  FreeSpaceTest::Result free_space() const { return free_space_.result(); }
  std::vector<Eigen::Vector3f> testable_points() const {
    const std::vector<std::uint8_t> tested = free_space_.tested();
    std::vector<Eigen::Vector3f> points;
    for (std::size_t i = 0; i < tested.size(); ++i) {
      if (tested[i] != 0) points.push_back(points_.position[i]);
    }
    return points;
  }

 private:
  const FrameSource& drive_;
  ColoredPoints points_;
  KdTree tree_;
  FreeSpaceTest free_space_;
};

void require_points(const ScoredMap& map, const ProtocolOptions& options) {
  map.points_local.check();
  if (map.points_local.empty()) {
    throw InputError("the map is empty", "evaluation", "map a drive first");
  }
  if (options.protocol == Protocol::kCrossCamera) {
    throw InputError("the map has no colors", "protocol cross-camera",
                     "use held-out or in-sample, which score positions");
  }
}

}  // namespace

bool has_colors(const ScoredMap& map) {
  const auto& camera = map.points_local.camera;
  return std::any_of(camera.begin(), camera.end(), [](std::int8_t c) { return c != kNoCamera; });
}

EvaluationReport evaluate_uncolored(ScoredMap map, const FrameSource& drive,
                                    const ProtocolOptions& options,
                                    const EvaluationProgress& progress) {
  require_points(map, options);
  const std::vector<PlacedFrame> frames = select_frames(map, drive, options);
  UncoloredScorer scorer(std::move(map.points_local), drive);
  EvaluationReport report;
  report.protocol = options.protocol;
  report.colored = false;
  SetCollector all;
  std::vector<Eigen::Vector3f> positions;
  const std::vector<ScanScore> scores =
      score_frames(frames, progress, [&](const PlacedFrame& frame) { return scorer.score(frame); });
  for (const ScanScore& score : scores) {
    if (score.unscored) {
      report.skipped.push_back(*score.unscored);
      continue;
    }
    ++report.frames;
    all.add(score.errors);
    positions.insert(positions.end(), score.positions.begin(), score.positions.end());
  }
  if (positions.empty()) {
    throw InputError("no LiDAR point could be scored", fmt::format("{} frames", frames.size()),
                     "check that the map belongs to this drive");
  }
  const std::vector<float>& distances = all.errors().position;
  const SetFigures figures = all.figures();
  report.figures = figures.figures;
  report.intervals = figures.intervals;
  report.thickness = plane_thickness(scorer.points().position);
  report.scan_scores = scan_scores(scorer.testable_points(), positions, distances);
  report.share_within_2mm = share_within(distances, 0.002f);
  report.stray = pose_stray(map.frames, frames);
  report.free_space = scorer.free_space();
  report.density_per_m2 = surface_density(scorer.points().position, positions);
  report.map_points = scorer.points().position.size();
  report.warnings = warnings(report);
  return report;
}

std::string uncolored_text(const EvaluationReport& report) {
  const ErrorFigures& f = report.figures;
  std::string text = fmt::format(
      "{}, positions alone (the map has no colors): {} points of {} frames ({} "
      "skipped)\n",
      to_string(report.protocol), f.points, report.frames, report.skipped.size());
  const auto row = [&](std::string_view name, double value, int digits,
                       std::string_view more = "") {
    text += fmt::format("  {:<22}{:>10.{}f}  {}\n", name, value, digits, more);
  };
  row("ME mean", f.me_mean, 4,
      fmt::format("m, std {:.4f}, 95%: {:.4f} to {:.4f}", f.me_std, report.intervals.me.low,
                  report.intervals.me.high));
  row("coverage 5 cm", f.coverage_5cm, 3);
  row("coverage 20 cm", f.coverage_20cm, 3);
  row("free-space violations", report.free_space.share(), 4,
      fmt::format("of {} map points; among returns all round {:.4f}", report.free_space.tested,
                  report.free_space.enclosed_share()));
  row("plane thickness", report.thickness.thickness, 4,
      fmt::format("m, median of {} patches", report.thickness.patches));
  row("F-score 5 / 10 / 20 cm", report.scan_scores.f_score[0], 3,
      fmt::format("{:.3f}, {:.3f}", report.scan_scores.f_score[1], report.scan_scores.f_score[2]));
  row("points per m^2", report.density_per_m2, 0, fmt::format("{} points", report.map_points));
  return text + explanation(report.protocol) + "\n";
}

}  // namespace fovea
