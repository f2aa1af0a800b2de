#include "app/html_report/figure_table.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "app/html_report/figure_explanations.h"
#include "app/html_report/markup.h"

namespace fovea::app {
namespace {

using Json = nlohmann::ordered_json;

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
      {"far_field", "Far field",
       "Visible returns from 15 to 60 m, on the ground and on what stands on it."},
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
