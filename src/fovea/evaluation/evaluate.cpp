#include "fovea/evaluation/evaluate.h"

#include <mutex>

#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/evaluation/scan_projection.h"

namespace fovea {
namespace {

/// What one frame adds to the report.
struct FrameScore {
  PointErrors errors, paper_like_errors;
  std::vector<std::uint8_t> hidden;        // 1 a point of `errors` that the camera cannot see
  std::vector<Eigen::Vector3f> positions;  // of its evaluated points, in the map's float frame
  std::vector<ViewReport> views;
  std::optional<UnscoredFrame> unscored;
};

/// The map made ready for questions; one for all frames.
class Scorer {
 public:
  Scorer(const ScoredMap& map, const FrameSource& drive, std::vector<std::size_t> cameras)
      : map_(map.points_local),
        drive_(drive),
        places_(std::move(cameras)),
        coloured_(coloured_points(map_)),
        coloured_tree_(coloured_.position),
        spacing_(sample_spacing(coloured_.position)),
        free_space_(coloured_) {
    for (const std::size_t place : places_) {
      cameras_.push_back(drive.info().calibration.cameras[place]);
    }
    if (coloured_.position.size() < map_.size()) {
      all_tree_.emplace(map_.position);
      all_color_ = map_.color;
      for (std::size_t i = 0; i < map_.size(); ++i) {
        if (map_.camera[i] == kNoCamera) all_color_[i] = Rgb{};
      }
    }
  }

  const ColouredPoints& coloured() const { return coloured_; }
  const std::vector<Camera>& cameras() const { return cameras_; }
  FreeSpaceTest::Result free_space() const { return free_space_.result(); }

  /// Thread-safe.
  FrameScore score(const PlacedFrame& placed) {
    FrameScore score;
    const DriveInfo& info = drive_.info();
    if (placed.index < info.begin || placed.index >= info.end) {
      score.unscored = {placed.index, "not in the drive"};
      return score;
    }
    const FrameResult loaded = drive_.load(placed.index);
    if (const auto* skipped = std::get_if<SkippedFrame>(&loaded)) {
      score.unscored = {placed.index,
                        std::string(to_string(skipped->reason)) + ": " + skipped->detail};
      return score;
    }
    const Frame& frame = std::get<Frame>(loaded);
    const PointCloud scan = compensated_scan(frame.scan, placed, info);
    for (std::size_t k = 0; k < places_.size(); ++k) {
      score_view(frame, scan, placed, cameras_[k], frame.images.at(places_[k]), score);
    }
    free_space_.add_scan(scan, placed.T_local_lidar, cameras_);
    return score;
  }

 private:
  void score_view(const Frame& frame, const PointCloud& scan, const PlacedFrame& placed,
                  const Camera& camera, const Image& image, FrameScore& score) const {
    const EvaluatedView view =
        evaluated_view(frame.scan, scan, placed, camera, image, coloured_.origin);
    const NearestSamples nearest =
        nearest_samples(view.position, coloured_tree_, coloured_.color, coloured_.interpolated);
    ViewReport report{placed.index, camera.index, {}, {}, {}};
    report.gains = fit_gains(view.color, nearest.color, view.grey);
    const PointErrors errors = point_errors(view, nearest, report.gains);
    report.figures = summarize(errors);
    report.gradients = draw_and_compare(placed, camera, image);
    score.errors.append(errors);
    mark(view, scan, camera, score);
    if (all_tree_) {
      const NearestSamples any = nearest_samples(view.position, *all_tree_, all_color_);
      score.paper_like_errors.append(
          point_errors(view, any, fit_gains(view.color, any.color, view.grey)));
    }
    score.positions.insert(score.positions.end(), view.position.begin(), view.position.end());
    score.views.push_back(report);
  }

  static void mark(const EvaluatedView& view, const PointCloud& scan, const Camera& camera,
                   FrameScore& score) {
    const ScanProjection projection(scan, camera);
    for (std::size_t i = 0; i < view.pixel.size(); ++i) {
      const Eigen::Vector3d p_lidar = scan.position[view.scan_index[i]].cast<double>();
      const double distance = (camera.T_cam_lidar * p_lidar).norm();
      score.hidden.push_back(projection.hidden(view.pixel[i], distance) ? 1 : 0);
    }
  }

  GradientSums draw_and_compare(const PlacedFrame& placed, const Camera& camera,
                                const Image& image) const {
    SplatOptions options;  // the depth that the evaluated points reach: beyond it nothing is scored
    options.min_depth = kEvaluatedDepth;
    options.max_depth = kEvaluatedFar;
    const RigidMotion T_cam_local = camera.T_cam_lidar * placed.T_local_lidar.inverse();
    return compare_gradients(splat(coloured_, spacing_, camera, T_cam_local, options), image);
  }

  const PointCloud& map_;
  const FrameSource& drive_;
  std::vector<std::size_t> places_;  // of the scored cameras in the drive's calibration
  std::vector<Camera> cameras_;      // the same
  ColouredPoints coloured_;
  KdTree coloured_tree_;
  std::vector<float> spacing_;
  FreeSpaceTest free_space_;
  std::optional<KdTree> all_tree_;  // where there are uncoloured points
  std::vector<Rgb> all_color_;
};

void require_coloured(const ScoredMap& map) {
  map.points_local.check();
  const auto& camera = map.points_local.camera;
  if (std::any_of(camera.begin(), camera.end(), [](std::int8_t c) { return c != kNoCamera; })) {
    return;
  }
  throw InputError("the map has no coloured point", "evaluation",
                   "score a map whose points have colours");
}

double share_interpolated(const ColouredPoints& map) {
  if (map.interpolated.empty()) return ErrorFigures::kNone;
  const auto made = std::count(map.interpolated.begin(), map.interpolated.end(), 1);
  return static_cast<double>(made) / static_cast<double>(map.interpolated.size());
}

std::vector<FrameScore> score_frames(Scorer& scorer, const std::vector<PlacedFrame>& frames,
                                     const EvaluationProgress& progress) {
  std::vector<FrameScore> scores(frames.size());
  std::mutex progress_mutex;
  std::size_t done = 0;
  parallel_for(frames.size(), 1, [&](std::size_t i) {
    scores[i] = scorer.score(frames[i]);
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress(++done, frames.size());
  });
  return scores;
}

}  // namespace

EvaluationReport evaluate(const ScoredMap& map, const FrameSource& drive,
                          const ProtocolOptions& options, const EvaluationProgress& progress) {
  require_coloured(map);
  const std::vector<PlacedFrame> frames = select_frames(map, drive, options);
  Scorer scorer(map, drive, select_cameras(map, drive.info(), options));
  std::vector<FrameScore> scores = score_frames(scorer, frames, progress);

  EvaluationReport report;
  report.protocol = options.protocol;
  for (const Camera& camera : scorer.cameras()) report.cameras.push_back(camera.index);
  SetCollector all, visible;
  PointErrors paper_like_errors;
  std::vector<Eigen::Vector3f> positions;
  for (FrameScore& score : scores) {  // in the order of frames, whichever was done first
    if (score.unscored) {
      report.skipped.push_back(*score.unscored);
      continue;
    }
    ++report.frames;
    all.add(score.errors);
    const PointErrors seen = score.errors.select(score.hidden, 0);
    visible.add(seen, score.errors.position.size() - seen.position.size());
    paper_like_errors.append(score.paper_like_errors);
    positions.insert(positions.end(), score.positions.begin(), score.positions.end());
    for (const ViewReport& view : score.views) {
      report.gradients += view.gradients;
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
  report.visible = visible.figures();
  report.map_share_interpolated = share_interpolated(scorer.coloured());
  report.paper_like =
      paper_like_errors.position.empty() ? report.figures : summarize(paper_like_errors);
  report.free_space = scorer.free_space();
  report.density_per_m2 = surface_density(scorer.coloured().position, positions);
  report.map_points = map.points_local.size();
  report.map_points_coloured = scorer.coloured().position.size();
  return report;
}

}  // namespace fovea
