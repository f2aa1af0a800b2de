#include "fovea/evaluation/evaluate_truth.h"

#include <cmath>
#include <unordered_map>
#include <utility>

#include "fovea/errors.h"
#include "fovea/evaluation/evaluate_uncolored.h"
#include "fovea/evaluation/metrics.h"
#include "fovea/evaluation/seams.h"
#include "fovea/evaluation/truth_colors.h"
#include "fovea/evaluation/truth_ghosts.h"
#include "fovea/evaluation/truth_upsampling.h"
#include "fovea/geometry/transform_cloud.h"

namespace fovea {
namespace {

constexpr double kDriftLength = 10;  // m

/// The points with colors; of a map without colors all points.
PointCloud scored_points(PointCloud points) {
  if (points.empty()) throw InputError("the map is empty", "evaluation", "map a drive first");
  std::vector<std::uint32_t> coloured;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (points.camera[i] != kNoCamera) coloured.push_back(i);
  }
  if (!coloured.empty()) points.keep(coloured);
  return points;
}

PoseFigures figures(const PoseErrors& errors) {
  return {distribution(errors.position_m), distribution(errors.rotation_deg)};
}

ColorFigures figures(ColorErrors errors) {
  ColorFigures figures;
  figures.within_20 = share_within(errors.raw, kColorWithin);
  figures.gain_within_20 = share_within(errors.gain, kColorWithin);
  figures.raw = distribution(std::move(errors.raw));
  figures.gain = distribution(std::move(errors.gain));
  return figures;
}

void put_poses(const std::vector<PosePair>& pairs, const RigidMotion& T_true_map_as_given,
               const RigidMotion& T_true_map_aligned, TruthReport& report) {
  const PoseErrors as_given = absolute_errors(pairs, T_true_map_as_given);
  const PoseErrors aligned = absolute_errors(pairs, T_true_map_aligned);
  report.pose_absolute = figures(as_given);
  report.pose_aligned = figures(aligned);
  report.pose_relative = figures(relative_errors(pairs));
  report.pose_drift_percent = distribution(drift_percent(pairs, kDriftLength));
  const PoseErrors& used = report.aligned ? aligned : as_given;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    report.frames.push_back({pairs[i].frame, used.position_m[i], used.rotation_deg[i], {}, {}});
  }
}

/// Ghosts of the whole map and of each frame.
void put_ghosts(const PointCloud& points, const std::vector<std::uint8_t>& is_ghost,
                TruthReport& report) {
  std::unordered_map<int, TruthFrame*> frames;
  for (TruthFrame& frame : report.frames) {
    frame.points = frame.ghosts = 0;
    frames[frame.frame] = &frame;
  }
  report.ghosts = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    *report.ghosts += is_ghost[i];
    const auto frame = frames.find(points.frame[i]);
    if (frame == frames.end()) continue;
    ++*frame->second->points;
    *frame->second->ghosts += is_ghost[i];
  }
}

/// Distances of the static points: all, those measured and those interpolated.
void put_accuracy(const SurfaceMatches& matches, const std::vector<std::uint8_t>& is_ghost,
                  const std::vector<std::uint8_t>& interpolated, TruthReport& report) {
  std::vector<float> all, parts[2];
  all.reserve(matches.distance.size());
  for (std::size_t i = 0; i < matches.distance.size(); ++i) {
    if (is_ghost[i] != 0) continue;
    all.push_back(matches.distance[i]);
    if (!interpolated.empty()) parts[interpolated[i] != 0 ? 1 : 0].push_back(matches.distance[i]);
  }
  report.accuracy = distribution(std::move(all));
  report.accuracy_measured = distribution(std::move(parts[0]));
  report.accuracy_interpolated = distribution(std::move(parts[1]));
}

double percent_of_stops(double stops) { return 100 * (std::exp2(stops) - 1); }

/// A line through the exposures of the views along the drive.
ExposureFigures exposure_figures(const std::vector<ViewExposure>& views,
                                 const std::vector<PosePair>& pairs) {
  constexpr std::size_t kLeastPoints = 100;
  constexpr double kLeastLength = 0.2;  // km
  std::unordered_map<int, double> kilometers;
  double path = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0) {
      path +=
          0.001 *
          (pairs[i].T_true_lidar.translation() - pairs[i - 1].T_true_lidar.translation()).norm();
    }
    kilometers[pairs[i].frame] = path;
  }
  std::vector<Eigen::Vector2d> points;  // km, stops
  for (const ViewExposure& view : views) {
    const auto place = kilometers.find(view.frame);
    if (view.points < kLeastPoints || place == kilometers.end()) continue;
    points.emplace_back(place->second, view.stops);
  }
  ExposureFigures figures;
  if (points.size() < 2) return figures;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p / double(points.size());
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) moments += (p - mean) * (p - mean).transpose();
  figures.deviation_percent = percent_of_stops(std::sqrt(moments(1, 1) / double(points.size())));
  if (path >= kLeastLength) {
    figures.trend_percent_per_km = percent_of_stops(moments(0, 1) / moments(0, 0));
  }
  return figures;
}

void put_colors(const ColouredTruth& coloured, const ScoredMap& map, const DriveTruth& truth,
                const FrameSource& drive, const std::vector<PosePair>& pairs, TruthReport& report) {
  ColorErrorSets albedo =
      albedo_errors(coloured, grey_cameras(truth, map.cameras, pairs.front().frame));
  report.color_albedo = figures(std::move(albedo.all));
  report.color_albedo_matte = figures(std::move(albedo.matte));
  if (coloured.points_true.frame.empty() || map.cameras.empty()) return;
  ViewErrors view = view_errors(coloured, truth, drive.info().calibration.cameras);
  report.color_view = figures(std::move(view.errors.all));
  report.color_view_matte = figures(std::move(view.errors.matte));
  report.exposure = exposure_figures(view.exposures, pairs);
  report.exposure.one_gain = distribution(std::move(view.one_gain));
  report.exposure.seam_p95_percent = find_seams(coloured.points_true).p95_percent;
}

void put_upsampling(UpsamplingErrors errors, TruthReport& report) {
  report.upsampling.frames = errors.frames;
  report.upsampling.hidden = errors.hidden;
  if (errors.hidden > 0) {
    report.upsampling.recovered =
        static_cast<double>(errors.recovered) / static_cast<double>(errors.hidden);
  }
  report.upsampling.error = distribution(std::move(errors.distance));
}

}  // namespace

TruthEvaluation evaluate_truth_points(ScoredMap map, const FrameSource& drive,
                                      const TruthOptions& options) {
  map.points_local.check();
  const DriveTruth truth(drive.info().path);
  const std::vector<PosePair> pairs = pose_pairs(map.frames, truth);
  const bool colored = has_colors(map);
  const std::size_t map_points = map.points_local.size();
  PointCloud points = scored_points(std::move(map.points_local));
  const std::vector<Camera>& cameras = drive.info().calibration.cameras;

  TruthReport report;
  report.scene = truth.scene();
  for (const Camera& camera : cameras) report.cameras.push_back(camera.index);
  report.aligned = options.align;
  report.map_points = map_points;
  report.colored = colored;
  report.map_points_coloured = report.colored ? points.size() : 0;

  const std::optional<RigidMotion> T_true_map_earth = georeference(map.meta, truth.origin());
  report.georeferenced = T_true_map_earth.has_value();
  const RigidMotion as_given = T_true_map_earth.value_or(RigidMotion::Identity());
  const RigidMotion aligned = align_trajectories(pairs);
  put_poses(pairs, as_given, aligned, report);

  std::vector<std::uint8_t> is_ghost(points.size(), 0);
  if (!points.frame.empty()) {
    is_ghost = find_ghosts(points, pairs, truth);
    put_ghosts(points, is_ghost, report);
  }

  const RigidMotion& T_true_map = options.align ? aligned : as_given;
  // Whole metres, near the points: floats relative to it are precise wherever the map lies.
  const Eigen::Vector3d origin_true = (T_true_map * points.origin).array().round();
  points = transform_cloud(std::move(points), T_true_map, origin_true);

  const World world = read_world(truth.folder());
  if (world.mesh_local.empty()) {
    throw InputError("the true world has no surface", truth.folder().string(),
                     "write the drive anew with 'fovea simulate'");
  }
  const SurfaceIndex surfaces(world.mesh_local);
  SurfaceMatches matches = match_surfaces(points, world, surfaces);
  put_accuracy(matches, is_ghost, points.interpolated, report);
  report.shares = surface_shares(matches.distance, points.position,
                                 seen_surface(truth, pairs, cameras, origin_true));

  if (report.colored) put_colors({points, matches, is_ghost}, map, truth, drive, pairs, report);
  put_upsampling(upsampling_errors(truth, pairs, cameras, surfaces), report);
  return {
      std::move(report), std::move(points), std::move(matches.distance), std::move(is_ghost), pairs,
      T_true_map};
}

TruthReport evaluate_truth(ScoredMap map, const FrameSource& drive, const TruthOptions& options) {
  return evaluate_truth_points(std::move(map), drive, options).report;
}

}  // namespace fovea
