#include "app/html_report/truth_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/html_report/chart_section.h"
#include "app/html_report/charts.h"
#include "app/html_report/foveal_pictures.h"
#include "app/html_report/map_picture.h"
#include "app/html_report/markup.h"
#include "app/html_report/page_layout.h"
#include "app/html_report/scan_pair.h"
#include "app/html_report/trajectory_chart.h"
#include "app/html_report/truth_figures.h"
#include "app/html_report/truth_views.h"

namespace fovea::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr Rgb kGhost{0, 229, 255};
/// The page's h0 to h5.
constexpr std::array<Rgb, kErrorClasses> kClassColors{Rgb{59, 15, 112},   Rgb{122, 31, 129},
                                                      Rgb{183, 55, 121},  Rgb{238, 93, 93},
                                                      Rgb{253, 165, 108}, Rgb{252, 247, 176}};

std::string percent(double share) {
  return std::isnan(share) ? "unknown" : fmt::format("{:.2f}%", 100 * share);
}

std::string cards_html(const TruthReport& r) {
  const Distribution& pose = r.aligned ? r.pose_aligned.position_m : r.pose_absolute.position_m;
  const TruthFrame* worst = worst_frame(r);
  std::string html = card("Pose error", fmt::format("{:.2f} cm", 100 * pose.mean),
                          worst == nullptr ? ""
                                           : fmt::format("worst frame {}: {:.2f} cm", worst->frame,
                                                         100 * worst->position_m));
  html += card("Drift over 10 m", number(r.pose_drift_percent.mean, 3) + "%",
               "at most " + number(r.pose_drift_percent.max, 3) + "%");
  html += card("Accuracy", fmt::format("{:.1f} mm", 1000 * r.accuracy.mean),
               fmt::format("95% within {:.1f} mm", 1000 * r.accuracy.p95));
  html += card("Complete within 5 cm", fmt::format("{:.1f}%", 100 * r.shares.completeness[1]),
               fmt::format("{:.1f}% within 20 cm", 100 * r.shares.completeness[3]));
  html += card("F-score, 2 cm", number(r.shares.f_score[0], 3),
               "at 5 cm " + number(r.shares.f_score[1], 3));
  html += card("Colour error", number(r.color_view.gain.mean, 3),
               "own perfect image, fitted gains; without " + number(r.color_view.raw.mean, 3));
  html += card("Ghosts", percent(ghost_share(r)),
               r.ghosts ? "of things that moved: " + count(*r.ghosts) + " points"
                        : "the points name no frame");
  return html;
}

/// Absolute error of each frame's position along, across and above the way.
Chart position_chart(const TruthEvaluation& e) {
  Chart chart;
  chart.title = "Position error of every frame";
  chart.x_label = chart.x_name = "frame";
  chart.y_label = "cm";
  chart.unit = " cm";
  chart.series = {{"distance", {}}, {"along the way", {}}, {"across", {}}, {"up", {}}};
  for (const PosePair& pair : e.poses) {
    const Eigen::Vector3d error =
        100 * (pair.T_true_lidar.inverse() * e.T_true_map * pair.T_map_lidar).translation();
    chart.x.push_back(pair.frame);
    chart.series[0].values.push_back(error.norm());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      chart.series[axis + 1].values.push_back(std::abs(error[static_cast<Eigen::Index>(axis)]));
    }
  }
  return chart;
}

Chart frame_chart(const TruthReport& report, const std::string& name, const std::string& unit,
                  double (*value)(const TruthFrame&)) {
  Chart chart;
  chart.title = name + " of every frame";
  chart.x_label = chart.x_name = "frame";
  chart.y_label = unit;
  chart.unit = unit;
  chart.series = {{name, {}}};
  for (const TruthFrame& frame : report.frames) {
    chart.x.push_back(frame.frame);
    chart.series[0].values.push_back(value(frame));
  }
  return chart;
}

std::string accuracy_panel(const TruthEvaluation& e) {
  constexpr float kBin = 1;  // mm
  std::vector<float> millimetres;
  for (std::size_t i = 0; i < e.distance.size(); ++i) {
    if (e.is_ghost[i] == 0) millimetres.push_back(1000 * e.distance[i]);
  }
  Histogram bars;
  bars.title = "Map points by distance to the nearest true surface";
  bars.x_label = "mm to the nearest true surface";
  bars.counts = histogram(millimetres, kBin);
  bars.width = kBin;
  bars.mean = 1000 * e.report.accuracy.mean;
  bars.median = 1000 * e.report.accuracy.median;
  return chart_panel("How far from the true surfaces?",
                     fmt::format("All {} static points; the last bar is the worst percent.",
                                 count(millimetres.size())),
                     histogram_chart(bars));
}

std::string track_panel(const TruthEvaluation& e) {
  GroundTrack track;
  track.north_up = true;  // the truth's frame
  for (std::size_t i = 0; i < e.poses.size(); ++i) {
    const TruthFrame& frame = e.report.frames[i];
    track.dashed.emplace_back(e.poses[i].T_true_lidar.translation().head<2>());
    track.line.emplace_back((e.T_true_map * e.poses[i].T_map_lidar.translation()).head<2>());
    track.spots.push_back({frame.frame, track.line.back(), 100 * frame.position_m,
                           fmt::format("frame {}: {:.2f} cm off, turned by {:.3f}\xC2\xB0",
                                       frame.frame, 100 * frame.position_m, frame.rotation_deg)});
  }
  std::array<double, kErrorClasses> shares{};
  for (const GroundTrack::Spot& spot : track.spots) {
    shares[kMeScale.class_of(spot.value)] += 1 / static_cast<double>(track.spots.size());
  }
  ErrorScale scale = kMeScale;
  scale.name = "position error";
  return chart_panel(
      "The drive from above",
      e.report.aligned ? "The map's poses as a line, laid over the true ones (dashed) by one rigid "
                         "motion; a dot a frame, darker is better."
                       : "The map's poses where the map says they are, as a line, the true ones "
                         "dashed; a dot a frame, darker is better.",
      ground_track_chart(track, scale) + legend(scale, shares));
}

std::string charts_html(const TruthPageInput& input) {
  const TruthEvaluation& e = input.evaluation;
  std::string html = track_panel(e) + "<div class=\"pair\" style=\"margin-top:1rem\">\n";
  html += chart_panel("Position error over the drive",
                      "As seen from the true LiDAR: along the way, across, up.",
                      line_chart(position_chart(e)));
  html +=
      chart_panel("Rotation error over the drive", "Angle between the map's pose and the true one.",
                  line_chart(frame_chart(e.report, "rotation error", "\xC2\xB0",
                                         [](const TruthFrame& f) { return f.rotation_deg; })));
  html += accuracy_panel(e);
  if (e.report.ghosts) {
    html += chart_panel(
        "Ghosts over the drive",
        "Share of the points that came from a frame which stem from something that moved.",
        line_chart(frame_chart(e.report, "ghosts", "%", [](const TruthFrame& f) {
          if (!f.points || *f.points == 0) return kNone;
          return 100 * static_cast<double>(*f.ghosts) / static_cast<double>(*f.points);
        })));
  }
  return html + latency_panel(input.map, input.drive.info()) + "</div>\n";
}

/// The map painted by the distance of its points to the true surfaces, ghosts in their own colour.
ColoredPoints painted(const TruthPoints& points, const TruthEvaluation& e) {
  ColoredPoints painted = points.coloured;
  for (std::size_t i = 0; i < painted.color.size(); ++i) {
    painted.color[i] =
        e.is_ghost[i] != 0 ? kGhost : kClassColors[kSurfaceScale.class_of(100.0 * e.distance[i])];
  }
  return painted;
}

const PosePair* pose_of(const TruthEvaluation& e, int frame) {
  const auto found = std::find_if(e.poses.begin(), e.poses.end(),
                                  [&](const PosePair& pair) { return pair.frame == frame; });
  return found == e.poses.end() ? nullptr : &*found;
}

/// The frame from which most ghosts came; null if there are none.
const TruthFrame* most_ghosts(const TruthReport& report) {
  const TruthFrame* most = nullptr;
  for (const TruthFrame& frame : report.frames) {
    if (frame.ghosts.value_or(0) > (most == nullptr ? 0 : *most->ghosts)) most = &frame;
  }
  return most;
}

std::string errors_html(const TruthPoints& points, const TruthEvaluation& e) {
  std::array<double, kErrorClasses> shares{};
  const double part = 1 / std::max(1.0, static_cast<double>(e.distance.size()));
  for (const float metres : e.distance) shares[kSurfaceScale.class_of(100.0 * metres)] += part;
  std::string html =
      "<p>Every point in the colour of its distance to the nearest true surface, from behind the "
      "vehicle; what stems from something that moved is bright blue.</p>\n" +
      legend(kSurfaceScale, shares) + "<div class=\"strip wide\">\n";
  const ColoredPoints colours = painted(points, e);
  std::vector<std::pair<int, std::string>> frames;
  if (const TruthFrame* worst = worst_frame(e.report)) {
    frames.emplace_back(worst->frame,
                        fmt::format("the pose is worst: {:.2f} cm", 100 * worst->position_m));
  }
  if (const TruthFrame* most = most_ghosts(e.report)) {
    frames.emplace_back(most->frame, "most ghosts came from here: " + count(*most->ghosts));
  }
  for (const auto& [frame, why] : frames) {
    const PosePair* pose = pose_of(e, frame);
    if (pose == nullptr) continue;
    html += fmt::format("<figure>{}<figcaption><b>Frame {}</b>, {}</figcaption></figure>\n",
                        picture_from_behind(colours, points.spacing, pose->T_true_lidar,
                                            fmt::format("Errors of the map at frame {}", frame)),
                        frame, why);
  }
  return html + "</div>\n";
}

std::string views_html(const std::vector<ViewPanel>& views, std::size_t frames) {
  if (views.empty()) return "<p>The drive was opened without a camera.</p>\n";
  return fmt::format(
      "<p>The map drawn from where the camera truly was, beside what a perfect camera would have "
      "seen: no noise, no vignetting, one exposure. Drag the divider, or use the arrow keys. The "
      "heat maps show map points, one in {} pixels square: the difference of their colour to the "
      "perfect image, after one gain a channel, and their distance to the nearest true surface. "
      "Shown: the frame with the worst pose and others, evenly spread, of {}.</p>\n{}",
      PointsInView::kCell, count(frames), stage(view_panels(views)));
}

std::string hero_html(const TruthPoints& points, const TruthEvaluation& e) {
  const PosePair& middle = e.poses[e.poses.size() / 2];
  return picture_from_behind(
      points.coloured, points.spacing, middle.T_true_lidar,
      fmt::format("The map from behind the vehicle at frame {}", middle.frame));
}

}  // namespace

std::string truth_page(const TruthPageInput& input) {
  const TruthEvaluation& e = input.evaluation;
  const auto json = nlohmann::ordered_json::parse(to_json(e.report));
  const DriveTruth truth(input.drive.info().path);
  const TruthPoints points = drawable(e);
  const std::vector<ViewPanel> views =
      truth_views(e, points, truth, input.drive.info().calibration.cameras);
  const std::vector<PlacedFrame> training = training_scans(input.map, input.drive, {});

  PageLayout page;
  page.map_name = input.map_name;
  page.drive_name = input.drive_name;
  page.protocol = "truth";
  page.frames_text = fmt::format("scene {}, {} frames", e.report.scene, e.report.frames.size());
  page.explanation = json.at("explanation").get<std::string>();
  page.defined_in = "docs/simulator.md";
  page.cameras = e.report.cameras;
  page.hero_html = hero_html(points, e);
  page.cards_html = cards_html(e.report);
  page.parts = {{"views", "Map beside truth", views_html(views, e.report.frames.size())},
                {"charts", "Charts", charts_html(input)},
                {"errors", "Where the map errs", errors_html(points, e)},
                {"registration", "Registration", scan_pair_section(input.drive, training)},
                {"fovea", "Foveal region", foveal_section(input.map, input.drive, training)},
                {"figures", "All figures",
                 truth_figure_tables(json) + "<details><summary>Every frame</summary>" +
                     truth_frame_table(json) + "</details>\n"}};
  return page_text(page);
}

}  // namespace fovea::app
