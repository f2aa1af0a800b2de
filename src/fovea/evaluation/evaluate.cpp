#include "fovea/evaluation/evaluate.h"

#include <utility>

#include "fovea/errors.h"
#include "fovea/evaluation/distribution.h"
#include "fovea/evaluation/evaluate_uncolored.h"
#include "fovea/evaluation/evaluation_setup.h"
#include "fovea/evaluation/scored_frames.h"
#include "fovea/evaluation/warnings.h"

namespace fovea {
namespace {

double share_interpolated(const ColoredPoints& map) {
  if (map.interpolated.empty()) return ErrorFigures::kNone;
  const auto made = std::count(map.interpolated.begin(), map.interpolated.end(), 1);
  return static_cast<double>(made) / static_cast<double>(map.interpolated.size());
}

/// The marks of points that are not hidden.
std::vector<std::uint8_t> select(const std::vector<std::uint8_t>& marks,
                                 const std::vector<std::uint8_t>& hidden) {
  std::vector<std::uint8_t> selected;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (hidden[i] == 0) selected.push_back(marks[i]);
  }
  return selected;
}

BleedingFigures bleeding_figures(const PointErrors& edges, const PointErrors& elsewhere) {
  const ErrorFigures at = summarize(edges), off = summarize(elsewhere);
  return {at.points, at.te_gain_mean, off.te_gain_mean, at.coverage_5cm, off.coverage_5cm};
}

/// The collected scores of blocks of frames, each on its own.
class BlockCollector {
 public:
  explicit BlockCollector(const std::vector<std::pair<int, int>>& blocks) {
    for (const auto& [first, last] : blocks) reports_.push_back({first, last, {}});
    errors_.resize(blocks.size());
  }
  void add(int frame, const PointErrors& errors) {
    for (std::size_t i = 0; i < reports_.size(); ++i) {
      if (frame >= reports_[i].first && frame <= reports_[i].last) errors_[i].append(errors);
    }
  }
  std::vector<BlockReport> reports() {
    for (std::size_t i = 0; i < reports_.size(); ++i) reports_[i].figures = summarize(errors_[i]);
    return reports_;
  }

 private:
  std::vector<BlockReport> reports_;
  std::vector<PointErrors> errors_;
};

}  // namespace

EvaluationReport evaluate(ScoredMap map, const FrameSource& drive, const ProtocolOptions& options,
                          const EvaluationProgress& progress) {
  if (!has_colors(map)) return evaluate_uncolored(std::move(map), drive, options, progress);
  const EvaluationSetup setup = prepare_evaluation(map, drive, options);
  const std::vector<PlacedFrame>& frames = setup.frames;
  const std::size_t map_points = map.points_local.size();
  Scorer scorer(std::move(map), drive, setup.scoring);
  std::vector<FrameScore> scores =
      score_frames(frames, progress, [&](const PlacedFrame& frame) { return scorer.score(frame); });
  scorer.free_indexes();

  EvaluationReport report;
  report.protocol = options.protocol;
  for (const Camera& camera : scorer.cameras()) report.cameras.push_back(camera.index);
  SetCollector all, visible, without_moving;
  BlockCollector block_collector(setup.blocks);
  PointErrors edges, elsewhere;
  std::vector<float> distances;
  PointErrors paper_like_errors;
  std::vector<Eigen::Vector3f> positions;
  for (std::size_t i = 0; i < scores.size(); ++i) {  // in the order of frames
    FrameScore& score = scores[i];
    if (score.unscored) {
      report.skipped.push_back(*score.unscored);
      continue;
    }
    ++report.frames;
    all.add(score.errors);
    const PointErrors seen = score.errors.select(score.hidden, 0);
    distances.insert(distances.end(), score.errors.position.begin(), score.errors.position.end());
    const std::vector<std::uint8_t> seen_edges = select(score.near_edge, score.hidden);
    edges.append(seen.select(seen_edges, 1));
    elsewhere.append(seen.select(seen_edges, 0));
    visible.add(seen, score.errors.position.size() - seen.position.size());
    without_moving.add(score.errors_without_moving,
                       score.errors.position.size() - score.errors_without_moving.position.size());
    block_collector.add(frames[i].index, score.errors);
    report.unreached += score.unreached;
    report.images_missing.insert(report.images_missing.end(), score.unscored_views.begin(),
                                 score.unscored_views.end());
    report.split.append(score.split);
    append(report.by_rule, score.by_rule);
    paper_like_errors.append(score.paper_like_errors);
    positions.insert(positions.end(), score.positions.begin(), score.positions.end());
    for (const ViewReport& view : score.views) {
      report.gradients += view.gradients;
      report.roughness += view.roughness;
      report.pictures += view.pictures;
      report.shift += view.shift;
      report.far_field += view.far_field;
      report.views.push_back(view);
    }
    score = {};
  }
  if (positions.empty()) {
    throw InputError("no LiDAR point could be scored",
                     std::to_string(report.frames) + " frames, " +
                         std::to_string(report.skipped.size()) + " skipped",
                     "check that the map belongs to this drive");
  }
  const SetFigures figures = all.figures();
  report.figures = figures.figures;
  report.intervals = figures.intervals;
  report.te_histogram = histogram(all.errors().color, kTeBin);
  report.visible = visible.figures();
  report.bleeding = bleeding_figures(edges, elsewhere);
  report.cross_view = scorer.cross_view();
  report.thickness = plane_thickness(scorer.coloured().position);
  report.scan_scores = scan_scores(scorer.testable_points(), positions, distances);
  report.share_within_2mm = share_within(distances, 0.002f);
  report.stray = pose_stray(scorer.map_frames(), frames);
  report.blocks = block_collector.reports();
  if (setup.scoring.moving) {
    report.without_moving =
        MovingReport{setup.scoring.moving->labelled(), setup.scoring.moving->moved(),
                     scorer.moving_points(), without_moving.figures()};
  }
  report.map_share_interpolated = share_interpolated(scorer.coloured());
  report.paper_like =
      paper_like_errors.position.empty() ? report.figures : summarize(paper_like_errors);
  report.free_space = scorer.free_space();
  report.density_per_m2 = surface_density(scorer.coloured().position, positions);
  report.map_points = map_points;
  report.map_points_coloured = scorer.coloured().position.size();
  report.warnings = warnings(report);
  return report;
}

}  // namespace fovea
