#include "fovea/evaluation/scorer.h"

#include <algorithm>
#include <map>
#include <utility>

#include "fovea/errors.h"
#include "fovea/evaluation/predicted_light.h"
#include "fovea/evaluation/scored_frames.h"
#include "fovea/mapping/scan_projection.h"

namespace fovea {
namespace {

void mark_points(const EvaluatedView& view, const PointCloud& scan, const Camera& camera,
                 FrameScore& score) {
  const ScanProjection projection(scan, camera);
  for (std::size_t i = 0; i < view.pixel.size(); ++i) {
    const Eigen::Vector3d p_lidar = scan.position[view.scan_index[i]].cast<double>();
    const double distance = (camera.T_cam_lidar * p_lidar).norm();
    const std::uint16_t sensor = scan.sensor_at(view.scan_index[i]);
    score.hidden.push_back(projection.hidden(view.pixel[i], distance, sensor) ? 1 : 0);
    score.near_edge.push_back(projection.near_edge(view.pixel[i], distance) ? 1 : 0);
  }
}

/// @param gains  factors of the channels
ColorDisplay exposure_of(const Eigen::Vector3f& gains) {
  return {{gains.array().max(1e-6f).log2(), {}}, /*tone_mapped=*/false};
}

}  // namespace

Scorer::AllPoints::AllPoints(const PointCloud& map_local)
    : position(map_local.position), color(map_local.color), tree(position, KdTree::kLargeLeafSize) {
  for (std::size_t i = 0; i < color.size(); ++i) {
    if (map_local.camera[i] == kNoCamera) color[i] = LogColor();
  }
}

Scorer::Scorer(ScoredMap map, const FrameSource& drive, ScorerOptions options)
    : frames_(std::move(map.frames)),
      drive_(drive),
      options_(std::move(options)),
      all_(std::count(map.points_local.camera.begin(), map.points_local.camera.end(), kNoCamera) > 0
               ? std::optional<AllPoints>(std::in_place, map.points_local)
               : std::nullopt),
      coloured_(colored_points(std::move(map.points_local))),
      spacing_(spacing_of(coloured_, map.meta)),
      coloured_tree_(coloured_.position, KdTree::kLargeLeafSize),
      free_space_(coloured_),
      cross_view_(coloured_) {
  for (const std::size_t place : options_.cameras) {
    cameras_.push_back(drive.info().calibration.cameras[place]);
  }
  if (options_.moving) mark_moving();
  coloured_.frame = {};  // they take memory, and are not used again
  coloured_.sampling_level = {};
}

void Scorer::mark_moving() {
  is_moving_.resize(coloured_.position.size());
  if (coloured_.frame.empty()) return;  // a cloud that does not name frames keeps what moved
  std::map<int, RigidMotion> T_lidar_map;
  for (const FrameRecord& record : frames_) {
    T_lidar_map[record.index] =
        record.T_local_lidar.inverse() * Eigen::Translation3d(coloured_.origin);
  }
  for (std::size_t i = 0; i < coloured_.position.size(); ++i) {
    const auto placed = T_lidar_map.find(coloured_.frame[i]);
    if (placed == T_lidar_map.end()) continue;
    const Eigen::Vector3d p_lidar = placed->second * coloured_.position[i].cast<double>();
    if (!options_.moving->contain(placed->first, p_lidar)) continue;
    is_moving_[i] = 1;
    ++moving_points_;
  }
}

FrameScore Scorer::score(const PlacedFrame& placed) {
  FrameScore score;
  const auto loaded = load_scored_frame(drive_, placed.index);
  if (const auto* unscored = std::get_if<UnscoredFrame>(&loaded)) {
    score.unscored = *unscored;
    return score;
  }
  const Frame& frame = std::get<Frame>(loaded);
  const PointCloud scan = compensated_scan(frame.scan, placed, drive_.info());
  std::vector<Camera> cameras;
  cameras.reserve(options_.cameras.size());
  for (const std::size_t place : options_.cameras) {
    cameras.push_back(drive_.info().camera_at(place, placed.index).at_image(placed.motion));
  }
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const Image& image = frame.images.at(options_.cameras[k]);
    if (image.empty()) {
      score.unscored_views.push_back({placed.index, cameras[k].index});
    } else {
      score_view(frame, scan, placed, cameras[k], image, score);
    }
  }
  if (score.views.empty()) {
    score.unscored = {placed.index, "no image of a scored camera"};
    score.unscored_views.clear();
    return score;
  }
  free_space_.add_scan(scan, placed.T_local_lidar, cameras, drive_.info().lidars);
  return score;
}

Scorer::ScoredPoints Scorer::score_points(const Frame& frame, const PointCloud& scan,
                                          const PlacedFrame& placed, const Camera& camera,
                                          const Image& image) const {
  ScoredPoints scored;
  EvaluatedView& view = scored.view;
  view = without_masked(evaluated_view(frame.scan, scan, placed, camera, image, coloured_.origin),
                        drive_.info().mask(camera.index));
  if (options_.reach) {
    const std::size_t all = view.position.size();
    view = select(view, options_.reach->reached(view.position, coloured_.origin,
                                                placed.T_local_lidar.translation()));
    scored.unreached = all - view.position.size();
  }
  scored.nearest =
      nearest_samples(view.position, coloured_tree_, coloured_.color, coloured_.interpolated);
  const NearestSamples& nearest = scored.nearest;
  scored.gains = fit_gains(view.color, nearest.color, view.grey);
  std::vector<Eigen::Vector3f> predicted;
  if (const auto light = predicted_light(frames_, placed.index, camera.index)) {
    predicted = predicted_colors(view, nearest.color, *light, camera);
  }
  scored.errors = point_errors(view, nearest, scored.gains, predicted);
  return scored;
}

SplatView Scorer::draw(const PlacedFrame& placed, const Camera& camera,
                       const SplatOptions& options) const {
  return splat(coloured_, spacing_, camera, camera.T_cam_lidar * placed.T_local_lidar.inverse(),
               options);
}

std::vector<ViewPicture> Scorer::pictures(const PlacedFrame& placed) const {
  std::vector<ViewPicture> pictures;
  auto loaded = load_scored_frame(drive_, placed.index);
  if (std::holds_alternative<UnscoredFrame>(loaded)) return pictures;
  Frame& frame = std::get<Frame>(loaded);
  const PointCloud scan = compensated_scan(frame.scan, placed, drive_.info());
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    const Camera camera =
        drive_.info().camera_at(options_.cameras[k], placed.index).at_image(placed.motion);
    Image& image = frame.images.at(options_.cameras[k]);
    if (image.empty()) continue;
    ScoredPoints scored = score_points(frame, scan, placed, camera, image);
    pictures.push_back(
        {placed.index, camera.index, std::move(image),
         draw(placed, camera,
              SplatOptions{.min_depth = kEvaluatedDepth, .display = exposure_of(scored.gains)}),
         std::move(scored.view), std::move(scored.errors)});
  }
  return pictures;
}

void Scorer::score_view(const Frame& frame, const PointCloud& scan, const PlacedFrame& placed,
                        const Camera& camera, const Image& image, FrameScore& score) {
  const auto [view, gains, errors, unreached, nearest] =
      score_points(frame, scan, placed, camera, image);
  score.unreached += unreached;
  ViewReport report{placed.index, camera.index, {}, {}, {}};
  report.gains = gains;
  report.figures = summarize(errors);
  compare_with_photograph(placed, camera, image, report);
  compare_far(frame.scan, scan, placed, camera, image, report);
  score.errors.append(errors);
  mark_points(view, scan, camera, score);
  score.split.append(
      split_errors(view, nearest_in(placed, camera, nearest), nearest.color, camera, image));
  append(score.by_rule, errors_by_rule(errors, nearest.index, coloured_.reason));
  if (options_.moving && moving_points_ < coloured_.position.size()) {
    score_without_moving(view, scan, score);
  }
  if (all_) {
    const NearestSamples any = nearest_samples(view.position, all_->tree, all_->color);
    score.paper_like_errors.append(
        point_errors(view, any, fit_gains(view.color, any.color, view.grey)));
  }
  score.positions.insert(score.positions.end(), view.position.begin(), view.position.end());
  score.views.push_back(report);
}

void Scorer::compare_far(const PointCloud& measured, const PointCloud& scan,
                         const PlacedFrame& placed, const Camera& camera, const Image& image,
                         ViewReport& report) const {
  SplatOptions options{.min_depth = kEvaluatedDepth, .display = exposure_of(report.gains)};
  options.max_depth = double(kFarBands.back().far);
  report.far_field = compare_far_field(
      {coloured_.position, coloured_.color, coloured_tree_, coloured_.origin}, measured, scan,
      placed, camera, {image, draw(placed, camera, options), drive_.info().mask(camera.index)});
}

std::vector<Eigen::Vector3d> Scorer::nearest_in(const PlacedFrame& placed, const Camera& camera,
                                                const NearestSamples& nearest) const {
  const RigidMotion T_cam_map =
      camera.T_cam_lidar * placed.T_local_lidar.inverse() * Eigen::Translation3d(coloured_.origin);
  std::vector<Eigen::Vector3d> p_cam;
  p_cam.reserve(nearest.index.size());
  for (const std::uint32_t i : nearest.index) {
    p_cam.push_back(T_cam_map * coloured_.position[i].cast<double>());
  }
  return p_cam;
}

void Scorer::score_without_moving(const EvaluatedView& view, const PointCloud& scan,
                                  FrameScore& score) const {
  std::vector<std::uint8_t> stands(view.position.size());
  for (std::size_t i = 0; i < stands.size(); ++i) {
    stands[i] =
        options_.moving->contain(view.frame, scan.position[view.scan_index[i]].cast<double>()) ? 0
                                                                                               : 1;
  }
  const EvaluatedView standing = select(view, stands);
  const NearestSamples nearest = nearest_samples(standing.position, coloured_tree_, coloured_.color,
                                                 coloured_.interpolated, is_moving_);
  score.errors_without_moving.append(
      point_errors(standing, nearest, fit_gains(standing.color, nearest.color, standing.grey)));
}

void Scorer::free_indexes() {
  all_.reset();
  spacing_ = {};
  coloured_tree_ = KdTree({});
}

std::vector<Eigen::Vector3f> Scorer::testable_points() const {
  const std::vector<std::uint8_t> tested = free_space_.tested();
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < tested.size(); ++i) {
    if (tested[i] != 0) points.push_back(coloured_.position[i]);
  }
  return points;
}

void Scorer::compare_with_photograph(const PlacedFrame& placed, const Camera& camera,
                                     const Image& image, ViewReport& report) {
  SplatOptions options;  // the depth that the evaluated points reach: beyond it nothing is scored
  options.min_depth = kEvaluatedDepth;
  options.max_depth = kEvaluatedFar;
  const RigidMotion T_cam_local = camera.T_cam_lidar * placed.T_local_lidar.inverse();
  options.display = exposure_of(report.gains);
  const SplatView drawn = draw(placed, camera, options);
  report.gradients = compare_gradients(drawn, image);
  report.roughness = compare_roughness(drawn, image);
  report.pictures = compare_pictures(drawn, image);
  report.shift = compare_shifts(drawn, image);
  cross_view_.add_view(drawn, camera, T_cam_local, image, report.gains);
}

}  // namespace fovea
