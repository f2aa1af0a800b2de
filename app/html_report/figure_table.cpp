#include "app/html_report/figure_table.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "app/html_report/markup.h"

namespace fovea::app {
namespace {

using Json = nlohmann::ordered_json;

/// By the name of a figure, or its whole place where a name means something else there.
const std::map<std::string, const char*>& explanations() {
  static const std::map<std::string, const char*> all{
      {"points", "evaluated LiDAR points: a fixed set that no map has a say in"},
      {"me_mean", "distance to the nearest coloured map point (m), mean"},
      {"me_std", "its standard deviation (m)"},
      {"te_mean",
       "difference to that point's colour, Euclidean in RGB (0-441; intensity 0-255 for "
       "grey cameras), mean"},
      {"te_std", "its standard deviation"},
      {"te_median", "its median"},
      {"te_within_20", "share of points whose colour is right within 20"},
      {"te_gain_mean",
       "TE after one gain a channel and view, fitted by least squares: without "
       "differences of exposure"},
      {"te_gain_within_20", "share within 20 after these gains"},
      {"mtme", "mean of ME x TE of each point"},
      {"coverage_5cm", "share of points with a coloured map point within 5 cm"},
      {"coverage_20cm", "the same within 20 cm"},
      {"te_percent", "mean TE in % of 255, as the paper quotes it"},
      {"te_ciede2000_mean",
       "colour difference as the eye sees it (CIEDE2000; 1 is just "
       "noticeable), mean"},
      {"te_ciede2000_median", "its median"},
      {"share_interpolated", "share of the nearest map points that upsampling made"},
      {"intervals_95.me_mean",
       "95% interval of the mean ME (whole frames drawn again, 2000 times)"},
      {"intervals_95.te_mean", "95% interval of the mean TE"},
      {"intervals_95.mtme", "95% interval of MTME"},
      {"free_space_violations",
       "share of map points that stand over 20 cm in front of every return "
       "around their ray"},
      {"free_space_violations_enclosed",
       "those with returns above and below them, too, within a cone wider than the gaps between "
       "rings"},
      {"free_space_points", "map points that a scored scan could test for that"},
      {"sharpness",
       "image gradient of the drawn map over the photograph's: 1 is as sharp, noise "
       "adds to it"},
      {"detail",
       "how much of the photograph's gradients the drawn map repeats: noise adds nothing"},
      {"sharpness_pixels", "pixels where both are taken"},
      {"density_per_m2", "map points a square metre of surface"},
      {"map_points", "points of the map"},
      {"colored", "whether the map has colors; if not, positions alone are scored"},
      {"map_points_coloured", "those that a camera coloured"},
      {"map_share_interpolated", "share of them that upsampling made"},
      {"left_out", "evaluated points that are not in this set"},
      {"bleeding.points_edges", "visible points at edges of depth"},
      {"bleeding.te_edges", "mean TE there: colours of a foreground that bleed show here"},
      {"bleeding.te_elsewhere", "mean TE of the other visible points"},
      {"bleeding.coverage_5cm_edges", "share at edges with a map point within 5 cm"},
      {"bleeding.coverage_5cm_elsewhere", "the same elsewhere"},
      {"split.points", "scored points whose nearest map point the view shows, too"},
      {"split.te_mean", "their mean TE"},
      {"split.te_sampling",
       "of it, what a perfect colour of the nearest map point would leave: it lies elsewhere"},
      {"split.te_same_place",
       "the colour of the nearest map point against the photograph at that very place"},
      {"consistency.roughness", "luma noise of the map where the photograph is smooth"},
      {"consistency.roughness_patches", "smooth patches of 8 x 8 pixels"},
      {"consistency.cross_view_rms",
       "distance of a map point's colour to the held-out views' that "
       "show it, RMS"},
      {"consistency.cross_view_floor", "what no map with one colour a point undercuts"},
      {"consistency.cross_view_points", "map points that several views show"},
      {"geometry.plane_thickness",
       "RMS distance of points to the plane on flat surfaces (m), "
       "median"},
      {"geometry.planar_patches", "flat cubes of 20 cm"},
      {"pictures.psnr_covered",
       "drawn map against photograph where something is drawn, to 15 m "
       "(dB)"},
      {"pictures.psnr_all", "the same on all pixels, nothing drawn being black (dB)"},
      {"pictures.ssim_covered", "structural similarity where something is drawn"},
      {"pictures.ssim_all", "the same on all pixels"},
      {"pictures.covered", "share of pixels where something is drawn"},
      {"pictures.shift",
       "whole shift (x, y pixels) under which drawing and photograph differ "
       "least"},
      {"share_within_2mm",
       "share of points with a map point within 2 mm: many mean that the map "
       "holds the scored scans"},
      {"pose_stray.scored",
       "how far corrections of navigation at scored frames stray from their "
       "neighbours' (m)"},
      {"pose_stray.mapped", "the same at mapped frames (m)"},
      {"without_moving.boxes", "labelled objects"},
      {"without_moving.boxes_moved", "those that moved"},
      {"without_moving.map_points_left_out", "map points in them"},
      {"blocks.left_out", "points beyond what any training frame could see"},
      {"frames_scored", "frames that were scored"},
      {"worst_frame.frame", "frame of the highest mean TE"},
      {"worst_frame.camera", "camera of it"},
      {"first_frame", "first frame of a block"},
      {"last_frame", "last frame of it"},
      {"points_coloured", "points that the rule gave a colour"},
      {"rule", "colour rule, on identical points (docs/method.md)"},
      {"oracle", "whether it knows the held-out colours: a floor, no rule"},
  };
  return all;
}

const std::vector<FigureGroup>& groups() {
  static const std::vector<FigureGroup> all{
      {"", "All scored points", "Every figure against coloured map points only."},
      {"intervals_95", "95% intervals", "Points of a frame err together, so frames are drawn."},
      {"visible", "Visible points",
       "Without the points that the camera cannot see because LiDAR and camera stand apart."},
      {"without_moving", "Without what moved",
       "Without the boxes of objects that moved, where the drive has labels."},
      {"bleeding", "Bleeding at edges of depth", "Points within 5 pixels of an edge."},
      {"split", "Place and colour", "What of TE comes from the nearest point's distance."},
      {"by_rule", "By the nearest point's rule",
       "What let that point into the map: a return, a sample between returns, and of which kind."},
      {"consistency", "Consistency of colours", ""},
      {"geometry", "Geometry", "Precision, recall and F-score within 5, 10 and 20 cm."},
      {"pictures", "Pictures", "The map drawn into the scored views."},
      {"pose_stray", "Stray of poses", "Poses fitted to held-out colours would leave the course."},
      {"worst_frame", "Worst frame", ""},
      {"blocks", "Blocks of held-out frames",
       "Scored where a training frame's white zone reached."},
      {"color_rules", "Colour rules", "The same points, coloured again by each rule."},
      {"paper_like", "As the paper's baselines",
       "Nearest among all map points, uncoloured ones counting as black."},
  };
  return all;
}

bool begins_so(const FigureGroup& group, const std::string& name) {
  return group.key.ends_with('_') && name.starts_with(group.key);
}

bool is_grouped(const std::vector<FigureGroup>& groups, const std::string& name) {
  return std::any_of(groups.begin(), groups.end(), [&](const FigureGroup& group) {
    return name == group.key || begins_so(group, name);
  });
}

std::string shown(const Json& value) {
  if (value.is_null()) return "none";
  if (value.is_number_float()) return number(value.get<double>());
  if (value.is_number_unsigned()) return count(value.get<std::size_t>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return escaped(value.get<std::string>());
  if (value.is_array()) {
    std::string all;
    for (const Json& part : value) all += (all.empty() ? "" : " to ") + shown(part);
    return all;
  }
  return escaped(value.dump());
}

bool is_figure(const Json& value) {
  const auto scalar = [](const Json& v) { return v.is_number() || v.is_null() || v.is_boolean(); };
  return scalar(value) || (value.is_array() && value.size() == 2 && scalar(value[0]));
}

/// Rows of one report's tables.
class Rows {
 public:
  explicit Rows(const std::function<std::string(const std::string&)>& explain)
      : explain_(explain) {}

  void add(const std::string& key, const Json& value) {
    const std::string name = key.substr(key.rfind('.') + 1);
    std::string text = shown(value);
    if (name == "shift" && value.size() == 2)
      text = fmt::format("({}, {})", value[0].dump(), value[1].dump());
    html_ += fmt::format(
        "<tr data-key=\"{}\" data-value=\"{}\"><th scope=\"row\"><code>{}</code></th><td>{}</td>"
        "<td>{}</td></tr>\n",
        escaped(key), escaped(value.dump()), escaped(name), text, escaped(explain_(key)));
  }
  void add_heading(const std::string& text) {
    html_ += fmt::format("<tr class=\"part\"><th colspan=\"3\">{}</th></tr>\n", escaped(text));
  }
  /// Of the figures in an object; of lists in it, of each entry in turn.
  void add_all(const std::string& prefix, const Json& object) {
    for (const auto& [name, value] : object.items()) {
      const std::string key = prefix.empty() ? name : prefix + "." + name;
      if (is_figure(value)) {
        add(key, value);
      } else if (name == "intervals_95" || (name == "list" && !value.empty())) {
        add_all(key, value);
      } else if (!prefix.empty() && value.is_object()) {
        add_heading(value.contains("rule") ? value["rule"].get<std::string>() : name);
        add_all(key, value);
      }
    }
  }
  /// Of all that begins as a group does; objects with a heading.
  void add_beginning(const FigureGroup& group, const Json& report) {
    for (const auto& [name, value] : report.items()) {
      if (!begins_so(group, name)) continue;
      if (is_figure(value)) {
        add(name, value);
      } else if (value.is_object()) {
        const std::string what = explain_(name);
        add_heading(what.empty() ? name : name + ": " + what);
        add_all(name, value);
      }
    }
  }
  const std::string& html() const { return html_; }

 private:
  const std::function<std::string(const std::string&)>& explain_;
  std::string html_;
};

}  // namespace

std::string figure_tables(const Json& report, const std::vector<FigureGroup>& groups,
                          const std::function<std::string(const std::string& key)>& explain) {
  std::string html;
  for (const FigureGroup& group : groups) {
    Rows rows(explain);
    if (group.key.empty()) {
      Json top;
      for (const auto& [name, value] : report.items()) {
        if (is_figure(value) && !is_grouped(groups, name) && name != "cameras") top[name] = value;
      }
      rows.add_all("", top);
    } else if (group.key.ends_with('_')) {
      rows.add_beginning(group, report);
    } else if (report.contains(group.key)) {
      const Json& part = report[group.key];
      for (std::size_t i = 0; part.is_array() && i < part.size(); ++i) {
        rows.add_all(group.key, Json{{std::to_string(i), part[i]}});
      }
      if (part.is_object()) rows.add_all(group.key, part);
    }
    if (rows.html().empty()) continue;
    html += fmt::format(
        "<details{}><summary>{} <small>{}</small></summary>\n<table class=\"figures\"><thead><tr>"
        "<th>figure</th><th>value</th><th>meaning</th></tr></thead><tbody>\n{}"
        "</tbody></table></details>\n",
        html.empty() ? " open=\"open\"" : "", escaped(group.title), escaped(group.text),
        rows.html());
  }
  return html;
}

std::string explain_figure(const std::string& key) {
  const auto& all = explanations();
  // The whole place, then without its first parts: "visible.te_mean", then "te_mean".
  for (std::string rest = key;;) {
    const auto found = all.find(rest);
    if (found != all.end()) return found->second;
    const std::size_t dot = rest.find('.');
    if (dot == std::string::npos) break;
    rest.erase(0, dot + 1);
  }
  const std::string name = key.substr(key.rfind('.') + 1);
  for (const auto& [start, text] :
       {std::pair{"precision_", "share of the map's points near an evaluated point"},
        std::pair{"recall_", "share of the evaluated points near a map point"},
        std::pair{"f_score_", "harmonic mean of the two"}}) {
    if (name.starts_with(start)) return text;
  }
  return "";
}

std::string figure_tables(const Json& report) {
  return figure_tables(report, groups(), explain_figure);
}

std::string view_table(const Json& report) {
  constexpr std::array kColumns{"points",       "me_mean",      "te_mean",      "te_median",
                                "te_within_20", "coverage_5cm", "psnr_covered", "ssim_covered"};
  std::string html =
      "<table class=\"figures views\"><thead><tr><th>frame</th><th>camera</th><th>points</th>"
      "<th>ME m</th><th>TE</th><th>median</th><th>within 20</th><th>within 5 cm</th><th>PSNR "
      "dB</th>"
      "<th>SSIM</th></tr></thead><tbody>\n";
  for (const Json& view : report.at("frames")) {
    html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>", view.at("frame").dump(),
                        view.at("camera").dump());
    for (const char* column : kColumns) html += "<td>" + shown(view.at(column)) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

}  // namespace fovea::app
