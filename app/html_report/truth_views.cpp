#include "app/html_report/truth_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/html_report/markup.h"
#include "fovea/evaluation/evaluated_set.h"
#include "fovea/evaluation/metrics.h"
#include "fovea/rendering/splat.h"

namespace fovea::app {
namespace {

constexpr float kOnSurface = 0.05f;  // m

/// The frames to show, the worst first.
std::vector<const TruthFrame*> choose_frames(const TruthReport& report, std::size_t most) {
  std::vector<const TruthFrame*> chosen, others;
  const TruthFrame* worst = worst_frame(report);
  if (worst == nullptr || most == 0) return chosen;
  chosen.push_back(worst);
  for (const TruthFrame& frame : report.frames) {
    if (&frame != worst) others.push_back(&frame);
  }
  for (const std::size_t place : evenly_spread(others.size(), most - 1)) {
    chosen.push_back(others[place]);
  }
  return chosen;
}

std::string share(double part, double whole) {
  return whole > 0 ? fmt::format("{:.2f}%", 100 * part / whole) : "none";
}

float median_of(std::vector<float> values) { return float(distribution(std::move(values)).median); }

std::vector<std::pair<std::string, std::string>> facts(const TruthFrame& frame,
                                                       const ViewPanel& panel) {
  std::vector<std::pair<std::string, std::string>> facts{
      {"pose is off by", fmt::format("{:.2f} cm", 100 * frame.position_m)},
      {"and turned by", fmt::format("{:.3f}\xC2\xB0", frame.rotation_deg)}};
  if (frame.points && frame.ghosts) {
    facts.emplace_back("points from this frame", count(*frame.points));
    facts.emplace_back("ghosts among them", share(static_cast<double>(*frame.ghosts),
                                                  static_cast<double>(*frame.points)));
  }
  if (!panel.pixels.empty()) {
    facts.emplace_back("median distance here",
                       fmt::format("{:.1f} mm", 10 * median_of(panel.position)));
    facts.emplace_back("median colour error here", fmt::format("{:.1f}", median_of(panel.color)));
  }
  return facts;
}

}  // namespace

TruthPoints drawable(const TruthEvaluation& evaluation) {
  TruthPoints points{colored_points(evaluation.points_true), {}};
  points.spacing = sample_spacing(points.coloured.position);
  return points;
}

PointsInView points_in_view(const ColoredPoints& points, const SplatView& drawn,
                            const Camera& camera, const RigidMotion& T_cam_points) {
  const int columns = (camera.width + PointsInView::kCell - 1) / PointsInView::kCell;
  const int rows = (camera.height + PointsInView::kCell - 1) / PointsInView::kCell;
  struct Cell {
    double to_middle = std::numeric_limits<double>::infinity(), depth = 0;
    std::uint32_t index = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  };
  std::vector<Cell> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (std::uint32_t i = 0; i < points.position.size(); ++i) {
    const Eigen::Vector3d p = T_cam_points * points.position[i].cast<double>();
    if (!(p.z() > kEvaluatedDepth)) continue;
    const auto pixel = camera.project(p);
    if (!pixel || !camera.in_view(*pixel)) continue;
    const auto u = static_cast<std::size_t>(std::lround(pixel->x()));
    const auto v = static_cast<std::size_t>(std::lround(pixel->y()));
    const double front = drawn.depth[v * static_cast<std::size_t>(camera.width) + u];
    if (!(p.z() <= front + std::max(0.05, 0.01 * p.z()))) continue;  // hidden behind the map
    const std::size_t x = u / PointsInView::kCell, y = v / PointsInView::kCell;
    const Eigen::Vector2d middle =
        PointsInView::kCell * Eigen::Vector2d(double(x) + 0.5, double(y) + 0.5) -
        Eigen::Vector2d(0.5, 0.5);
    Cell& cell = cells[y * static_cast<std::size_t>(columns) + x];
    const double to_middle = (*pixel - middle).norm();
    if (to_middle < cell.to_middle) cell = {to_middle, p.z(), i, *pixel};
  }
  PointsInView view;
  for (const Cell& cell : cells) {
    if (!std::isfinite(cell.to_middle)) continue;
    view.index.push_back(cell.index);
    view.pixels.push_back(cell.pixel);
    view.depth.push_back(cell.depth);
  }
  return view;
}

std::vector<float> perfect_color_errors(const ColoredPoints& points, const PointsInView& view,
                                        const std::vector<float>& distance, const Image& perfect) {
  const bool grey = perfect.channels == 1;
  std::vector<Eigen::Vector3f> seen, mapped, seen_near, mapped_near;
  for (std::size_t k = 0; k < view.index.size(); ++k) {
    seen.push_back(bilinear(perfect, view.pixels[k].x(), view.pixels[k].y()));
    mapped.push_back(to_float(points.color[view.index[k]]));
    if (!(distance[view.index[k]] <= kOnSurface)) continue;
    seen_near.push_back(seen.back());
    mapped_near.push_back(mapped.back());
  }
  const Eigen::Vector3f gains = fit_gains(seen_near, mapped_near, grey);
  std::vector<float> errors;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    errors.push_back(color_error(seen[k], mapped[k].cwiseProduct(gains), grey));
  }
  return errors;
}

std::vector<ViewPanel> truth_views(const TruthEvaluation& evaluation, const TruthPoints& points,
                                   const DriveTruth& truth, const std::vector<Camera>& cameras) {
  std::vector<ViewPanel> panels;
  if (cameras.empty()) return panels;
  const TruthFrame* worst = worst_frame(evaluation.report);
  const std::size_t most = std::max<std::size_t>(1, kMaxViews / cameras.size());
  for (const TruthFrame* frame : choose_frames(evaluation.report, most)) {
    for (const Camera& camera : cameras) {
      const RigidMotion T_cam_true = truth.camera(camera.index)
                                         .T_local_cam.at(static_cast<std::size_t>(frame->frame))
                                         .inverse();
      const SplatView drawn = splat(points.coloured, points.spacing, camera, T_cam_true,
                                    {.min_depth = kEvaluatedDepth});
      const PointsInView view =
          points_in_view(points.coloured, drawn, camera,
                         T_cam_true * Eigen::Translation3d(points.coloured.origin));
      ViewPanel panel;
      panel.frame = frame->frame;
      panel.camera = camera.index;
      panel.photograph = truth.perfect_image(camera.index, frame->frame);
      panel.drawn = drawn.image;
      panel.photograph_name = "perfect image";
      if (frame == worst) panel.tag = "the worst pose";
      panel.pixels = view.pixels;
      panel.color =
          perfect_color_errors(points.coloured, view, evaluation.distance, panel.photograph);
      for (const std::uint32_t i : view.index) {
        panel.position.push_back(100 * evaluation.distance[i]);
      }
      panel.color_scale = kPerfectScale;
      panel.position_scale = kSurfaceScale;
      panel.button = fmt::format("{:.1f} cm off", 100 * frame->position_m);
      panel.bar = worst->position_m > 0 ? frame->position_m / worst->position_m : 0;
      panel.facts = facts(*frame, panel);
      panels.push_back(std::move(panel));
    }
  }
  return panels;
}

}  // namespace fovea::app
