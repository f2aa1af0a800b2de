#include "app/html_report/report_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "app/html_report/chart_section.h"
#include "app/html_report/close_ups.h"
#include "app/html_report/figure_table.h"
#include "app/html_report/foveal_pictures.h"
#include "app/html_report/map_picture.h"
#include "app/html_report/markup.h"
#include "app/html_report/page_layout.h"
#include "app/html_report/scan_pair.h"
#include "app/html_report/view_section.h"
#include "fovea/evaluation/evaluation_setup.h"

namespace fovea::app {
namespace {

std::string warnings_html(const EvaluationReport& report) {
  if (report.warnings.empty()) {
    return scores_held_out(report.protocol)
               ? "<div class=\"calm\"><p><b>No warnings.</b> No sign was found that the map plays "
                 "against single figures.</p></div>\n"
               : "<div class=\"warnings\" role=\"alert\"><p><b>Not quality:</b> the scans that "
                 "built the map score it. Warnings are for held-out scans only.</p></div>\n";
  }
  std::string html = fmt::format(
      "<div class=\"warnings\" role=\"alert\"><h2>{} warning{}: read the figures with "
      "care</h2><ul>",
      report.warnings.size(), report.warnings.size() == 1 ? "" : "s");
  for (const std::string& warning : report.warnings) html += "<li>" + escaped(warning) + "</li>";
  return html + "</ul></div>\n";
}

std::string cards_html(const EvaluationReport& report) {
  const ErrorFigures& f = report.figures;
  std::string html;
  const auto put = [&](const char* name, const std::string& value, const std::string& more) {
    html += card(name, value, more);
  };
  put("Texture error TE", fmt::format("{:.2f}", f.te_mean),
      fmt::format("95%: {:.2f} to {:.2f}; median {:.1f}", report.intervals.te.low,
                  report.intervals.te.high, f.te_median));
  put("Position error ME", fmt::format("{:.2f} cm", 100 * f.me_mean),
      fmt::format("95%: {:.2f} to {:.2f}", 100 * report.intervals.me.low,
                  100 * report.intervals.me.high));
  put("Colour within 20", fmt::format("{:.1f}%", 100 * f.te_within_20),
      fmt::format("of {} points", count(f.points)));
  put("Covered within 5 cm", fmt::format("{:.1f}%", 100 * f.coverage_5cm),
      fmt::format("{:.1f}% within 20 cm", 100 * f.coverage_20cm));
  put("Detail", number(report.gradients.detail(), 3),
      "sharpness " + number(report.gradients.sharpness(), 3));
  put("PSNR", number(report.pictures.psnr_covered(), 4) + " dB",
      "SSIM " + number(report.pictures.mean_ssim_covered(), 3) + " where drawn");
  put("Map", count(report.map_points_coloured),
      fmt::format("coloured points, {:.0f} a square metre", report.density_per_m2));
  return html;
}

std::string frames_text(const EvaluationReport& report) {
  return fmt::format("{} frame{}{}", report.frames, report.frames == 1 ? "" : "s",
                     report.skipped.empty()
                         ? std::string()
                         : fmt::format(" ({} could not be read)", report.skipped.size()));
}

/// The chosen views' pictures, in the order of the choice.
std::vector<ShownView> load_views(const Scorer& scorer, const EvaluationSetup& setup,
                                  const EvaluationReport& report) {
  std::vector<ShownView> shown;
  for (const ViewReport* view : choose_views(report)) {
    const auto placed = std::find_if(setup.frames.begin(), setup.frames.end(),
                                     [&](const PlacedFrame& f) { return f.index == view->frame; });
    if (placed == setup.frames.end()) continue;
    for (ViewPicture& picture : scorer.pictures(*placed)) {
      if (picture.camera == view->camera) shown.push_back({*view, std::move(picture)});
    }
  }
  return shown;
}

std::string left_out(const std::vector<ShownView>& shown, const EvaluationReport& report) {
  std::set<std::pair<int, int>> here;
  for (const ShownView& view : shown) here.emplace(view.report.frame, view.report.camera);
  std::vector<std::string> missing;
  for (const ViewReport& view : report.views) {
    if (!here.contains({view.frame, view.camera})) {
      missing.push_back(report.cameras.size() > 1
                            ? fmt::format("{} (camera {})", view.frame, view.camera)
                            : std::to_string(view.frame));
    }
  }
  if (missing.empty()) return "<p class=\"note\">All scored views are shown.</p>\n";
  return fmt::format(
      "<details><summary>{} scored views are not shown <small>to bound the page: the worst and "
      "evenly spread others are</small></summary><p>Left out are the pictures, not the figures, of "
      "frames {}.</p></details>\n",
      missing.size(), fmt::join(missing, ", "));
}

Part views_part(const std::vector<ShownView>& shown, const EvaluationReport& report) {
  Part part{"views", "Map beside photograph", ""};
  if (shown.empty()) {
    part.html = "<p>No scored view could be loaded again.</p>\n";
    return part;
  }
  part.html = fmt::format(
      "<p>The map drawn from where a photograph was taken{}. Drag the divider, or use the arrow "
      "keys. The heat maps show every scored LiDAR point: the difference of its colour (TE) or its "
      "distance (ME) to the nearest map point. Black: nothing is mapped there; the scores reach to "
      "{:g} m.</p>\n",
      scores_held_out(report.protocol) ? " that the map never saw" : " that it was coloured with",
      kEvaluatedFar);
  part.html += stage(view_section(shown)) + left_out(shown, report);
  return part;
}

Part figures_part(const nlohmann::ordered_json& json) {
  Part part{"figures", "All figures", figure_tables(json)};
  part.html += "<details><summary>Every scored view</summary>" + view_table(json) + "</details>\n";
  if (!json.at("skipped").empty()) {
    part.html += "<details><summary>Frames that could not be scored</summary><ul>";
    for (const auto& frame : json.at("skipped")) {
      part.html += fmt::format("<li>frame {}: {}</li>", frame.at("frame").dump(),
                               escaped(frame.at("reason").get<std::string>()));
    }
    part.html += "</ul></details>\n";
  }
  if (!json.at("images_missing").empty()) {
    part.html += "<details><summary>Images that are missing or damaged</summary><ul>";
    for (const auto& view : json.at("images_missing")) {
      part.html += fmt::format("<li>frame {}: camera {}</li>", view.at("frame").dump(),
                               view.at("camera").dump());
    }
    part.html += "</ul></details>\n";
  }
  return part;
}

}  // namespace

std::string report_page(const PageInput& input) {
  const EvaluationReport& report = input.report;
  const auto json = nlohmann::ordered_json::parse(to_json(report));
  const EvaluationSetup setup = prepare_evaluation(input.map, input.drive, input.options);
  const Scorer scorer(input.map, input.drive, setup.scoring);
  const std::vector<ShownView> shown = load_views(scorer, setup, report);

  std::vector<Part> parts;
  parts.push_back(views_part(shown, report));
  parts.push_back({"charts", "Charts", chart_section(input.map, input.drive.info(), report)});
  const std::vector<PlacedFrame> training = training_scans(input.map, input.drive, setup.frames);
  parts.push_back({"registration", "Registration", scan_pair_section(input.drive, training)});
  parts.push_back({"fovea", "Foveal region", foveal_section(input.map, input.drive, training)});
  parts.push_back({"texture", "Texture close up",
                   close_up_section(scorer, input.drive, training, setup.frames, shown)});
  parts.push_back(figures_part(json));
  return page_text({input.map_name, input.drive_name, to_string(report.protocol),
                    frames_text(report), explanation(report.protocol), "docs/method.md, section 7",
                    report.cameras, hero_picture(input.map, scorer), warnings_html(report),
                    cards_html(report), std::move(parts)});
}

}  // namespace fovea::app
