#include "app/html_report/truth_figures.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/html_report/figure_table.h"
#include "app/html_report/markup.h"

namespace fovea::app {
namespace {

using Json = nlohmann::ordered_json;

/// By the whole place of a figure, by what follows its first dot, or by how it begins ("..._").
const std::map<std::string, const char*>& explanations() {
  static const std::map<std::string, const char*> all{
      {"colored", "whether the map has colors; if not, all points are scored"},
      {"aligned", "whether the map's trajectory was laid over the true one first"},
      {"georeferenced", "whether the map says where on earth it lies"},
      {"map_points", "points of the map"},
      {"map_points_coloured", "those that a camera coloured: they are scored"},
      {"frames_compared", "frames of the map whose true pose is known"},
      {"pose_absolute_m", "LiDAR poses where the map says on earth they are (m)"},
      {"pose_absolute_deg", "the same, rotations (degrees)"},
      {"pose_aligned_m", "after one rigid motion that lays the trajectories over each other (m)"},
      {"pose_aligned_deg", "the same, rotations (degrees)"},
      {"pose_relative_m", "motion between frames that follow each other (m)"},
      {"pose_relative_deg", "the same, rotations (degrees)"},
      {"pose_drift_10m_percent", "motion over 10 m of the true way, % of it"},
      {"mean", "mean"},
      {"rmse", "root of the mean square"},
      {"max", "largest"},
      {"accuracy_mean", "distance of static map points to the nearest true surface (m), mean"},
      {"accuracy_measured_mean", "the same of measured points (m)"},
      {"accuracy_interpolated_mean", "the same of points that upsampling made (m)"},
      {"accuracy_median", "half are nearer (m)"},
      {"accuracy_measured_median", "half are nearer (m)"},
      {"accuracy_interpolated_median", "half are nearer (m)"},
      {"accuracy_p95", "95% are nearer (m)"},
      {"accuracy_measured_p95", "95% are nearer (m)"},
      {"accuracy_interpolated_p95", "95% are nearer (m)"},
      {"accuracy_max", "the farthest (m)"},
      {"accuracy_measured_max", "the farthest (m)"},
      {"accuracy_interpolated_max", "the farthest (m)"},
      {"accuracy_points", "static coloured points"},
      {"accuracy_measured_points", "those that were measured"},
      {"accuracy_interpolated_points", "those that upsampling made"},
      {"precision_", "share of the map's points, ghosts included, this near to a true surface"},
      {"completeness_", "share of the surface that was seen with a map point this near"},
      {"f_score_", "harmonic mean of precision and completeness"},
      {"seen_voxels", "cubes of 5 cm with surface that was seen, 3-15 m away and in view"},
      {"color_albedo", "against the albedo of the nearest true surface, which has no light on it"},
      {"color_albedo_matte", "the same on materials that mirror nothing"},
      {"color_view", "against the perfect image of the point's own frame and camera"},
      {"color_view_matte", "the same on materials that mirror nothing"},
      {"exposure.one_gain_mean", "the same after one gain a channel for the whole map, mean"},
      {"exposure.one_gain_median", "half are better"},
      {"exposure.trend_percent_per_km", "slope of map over truth along the drive (%/km)"},
      {"exposure.deviation_percent", "its standard deviation from view to view (%)"},
      {"exposure.seam_p95_percent",
       "steps of color between views within 3 cm (%), 95th percentile"},
      {"points", "points compared"},
      {"median", "half are better"},
      {"within_20", "share of points whose colour is right within 20"},
      {"gain_mean", "mean after one fitted gain a channel"},
      {"gain_median", "half are better after it"},
      {"gain_within_20", "share within 20 after it"},
      {"ghosts", "map points that stem from something that moved"},
      {"ghost_share", "share of the coloured points that are ghosts"},
      {"upsampling_mean",
       "every other ring of a true scan is hidden and the rest upsampled: distance of the new "
       "points to the true surface (m), mean"},
      {"upsampling_median", "half are nearer (m)"},
      {"upsampling_p95", "95% are nearer (m)"},
      {"upsampling_max", "the farthest (m)"},
      {"upsampling_points", "new points"},
      {"upsampling_hidden", "hits that were hidden"},
      {"upsampling_recovered_5cm", "share of them with a point within 5 cm"},
      {"upsampling_frames", "frames that were tried"},
      {"worst_frame.frame", "frame whose position is farthest off"},
      {"worst_frame.pose_m", "by so much (m)"},
      {"worst_frame.pose_deg", "and turned by (degrees)"},
      {"worst_frame.points", "coloured map points that came from it"},
      {"worst_frame.ghosts", "ghosts among them"},
  };
  return all;
}

std::string cell(const Json& value) {
  if (value.is_null()) return "none";
  return value.is_number_float() ? number(value.get<double>()) : count(value.get<std::size_t>());
}

}  // namespace

std::string explain_truth_figure(const std::string& key) {
  const auto& all = explanations();
  if (const auto found = all.find(key); found != all.end()) return found->second;
  if (const auto found = all.find(key.substr(key.find('.') + 1)); found != all.end()) {
    return found->second;
  }
  for (const auto& [start, text] : all) {
    if (start.ends_with('_') && key.starts_with(start)) return text;
  }
  return "";
}

std::string truth_figure_tables(const Json& report) {
  static const std::vector<FigureGroup> groups{
      {"", "The map", "What was compared."},
      {"pose_", "Poses", "Of the LiDAR at every scan's stamp, held-out frames included."},
      {"worst_frame", "Worst frame", ""},
      {"accuracy_", "Accuracy", "Distance of the map's points to the true surfaces."},
      {"precision_", "Precision", "Within 2, 5, 10 and 20 cm."},
      {"completeness_", "Completeness", "Within 2, 5, 10 and 20 cm."},
      {"f_score_", "F-score", "Precision and completeness in one."},
      {"color_", "Colours", "Euclidean in 8-bit sRGB (0-441)."},
      {"exposure", "One exposure", "Against the perfect images."},
      {"upsampling_", "Upsampling", "The method alone, on true scans: no map is involved."},
  };
  return figure_tables(report, groups, explain_truth_figure);
}

std::string truth_frame_table(const Json& report) {
  std::string html =
      "<table class=\"figures views\"><thead><tr><th>frame</th><th>position error m</th>"
      "<th>rotation error \xC2\xB0</th><th>points</th><th>ghosts</th></tr></thead><tbody>\n";
  for (const Json& frame : report.at("frames")) {
    html += fmt::format("<tr><th scope=\"row\">{}</th>", frame.at("frame").dump());
    for (const char* column : {"pose_m", "pose_deg", "points", "ghosts"}) {
      html += "<td>" + cell(frame.at(column)) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

}  // namespace fovea::app
