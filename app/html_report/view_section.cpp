#include "app/html_report/view_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/html_report/color_classes.h"
#include "app/html_report/markup.h"

namespace fovea::app {
namespace {

constexpr int kPhotographQuality = 85, kDrawnQuality = 80;

std::array<double, kErrorClasses> shares(const std::vector<float>& values,
                                         const ErrorScale& scale) {
  std::array<double, kErrorClasses> share{};
  for (const float value : values) ++share[scale.class_of(value)];
  for (double& s : share) s /= static_cast<double>(std::max<std::size_t>(1, values.size()));
  return share;
}

std::vector<float> in_centimetres(std::vector<float> metres) {
  for (float& value : metres) value *= 100;
  return metres;
}

std::string heat_layer(const char* type, const ViewPanel& view, const std::vector<float>& values,
                       const ErrorScale& scale) {
  return fmt::format(
      "<svg class=\"heat {}\" viewBox=\"-0.5 -0.5 {} {}\" aria-hidden=\"true\">\n{}</svg>\n", type,
      view.photograph.width, view.photograph.height, heat_paths(view.pixels, values, scale));
}

std::string facts_html(const ViewPanel& view) {
  std::string html = "<dl class=\"facts\">";
  for (const auto& [name, value] : view.facts) {
    html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", escaped(name), escaped(value));
  }
  return html + "</dl>\n";
}

std::string panel(std::size_t index, const ViewPanel& view) {
  const std::string name = fmt::format("frame {}, camera {}", view.frame, view.camera);
  const std::string shown_first = escaped(view.photograph_name);
  std::string html =
      fmt::format("<article class=\"view\" id=\"view-{}\" data-frame=\"{}\">\n<h3>F{}{}</h3>\n",
                  index, view.frame, name.substr(1),
                  view.tag.empty() ? "" : " <span class=\"tag\">" + escaped(view.tag) + "</span>");
  html += fmt::format(
      "<div class=\"compare\" style=\"aspect-ratio:{} / {}\">\n"
      "<img class=\"photograph\" alt=\"The {} of {}\" src=\"{}\"/>\n"
      "<img class=\"drawn\" alt=\"The map drawn from the same place\" src=\"{}\"/>\n",
      view.photograph.width, view.photograph.height, shown_first, name,
      jpeg_uri(view.photograph, kPhotographQuality), jpeg_uri(view.drawn, kDrawnQuality));
  html += heat_layer("te", view, view.color, view.color_scale);
  html += heat_layer("me", view, view.position, view.position_scale);
  html += fmt::format(
      "<span class=\"side left\">{0}</span><span class=\"side right\">map</span>\n"
      "<div class=\"divider\"></div>\n"
      "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"1\" "
      "aria-label=\"Share of the {0}, {1}\"/>\n</div>\n",
      shown_first, name);
  html += fmt::format("<div class=\"scale te\">{}</div><div class=\"scale me\">{}</div>\n",
                      legend(view.color_scale, shares(view.color, view.color_scale)),
                      legend(view.position_scale, shares(view.position, view.position_scale)));
  return html + facts_html(view) + "</article>\n";
}

std::vector<std::pair<std::string, std::string>> facts(const ViewReport& view) {
  const ErrorFigures& f = view.figures;
  return {{"scored points", count(f.points)},
          {"TE mean", fmt::format("{:.2f}", f.te_mean)},
          {"TE median", fmt::format("{:.2f}", f.te_median)},
          {"within 20", fmt::format("{:.1f}%", 100 * f.te_within_20)},
          {"ME mean", fmt::format("{:.1f} cm", 100 * f.me_mean)},
          {"within 5 cm", fmt::format("{:.1f}%", 100 * f.coverage_5cm)},
          {"PSNR", number(view.pictures.psnr_covered(), 4) + " dB"},
          {"SSIM", number(view.pictures.mean_ssim_covered(), 3)}};
}

}  // namespace

std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t room) {
  std::vector<std::size_t> places(std::min(room, count));
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = places.size() == 1 ? 0 : i * (count - 1) / (places.size() - 1);
  }
  return places;
}

std::vector<const ViewReport*> choose_views(const EvaluationReport& report, std::size_t most) {
  std::vector<const ViewReport*> chosen, others;
  const ViewReport* worst = worst_view(report);
  if (worst == nullptr || most == 0) return chosen;
  chosen.push_back(worst);
  for (const ViewReport& view : report.views) {
    if (&view != worst && view.figures.points > 0) others.push_back(&view);
  }
  for (const std::size_t place : evenly_spread(others.size(), most - 1)) {
    chosen.push_back(others[place]);
  }
  return chosen;
}

std::string heat_paths(const std::vector<Eigen::Vector2d>& pixels, const std::vector<float>& values,
                       const ErrorScale& scale) {
  std::array<std::vector<Eigen::Vector2i>, kErrorClasses> classes;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    classes[scale.class_of(values[i])].emplace_back(std::lround(pixels[i].x()),
                                                    std::lround(pixels[i].y()));
  }
  std::string svg;
  for (std::size_t k = 0; k < kErrorClasses; ++k) {
    if (classes[k].empty()) continue;
    svg += fmt::format("<path class=\"h{}\" d=\"", k);
    Eigen::Vector2i pen(0, 0);
    for (const Eigen::Vector2i& p : classes[k]) {  // a dot is a line of no length with round ends
      svg += fmt::format("m{} {}h0", p.x() - pen.x(), p.y() - pen.y());
      pen = p;
    }
    svg += "\"/>\n";
  }
  return svg;
}

std::string view_panels(const std::vector<ViewPanel>& views) {
  std::string html = "<div class=\"picker\" role=\"group\" aria-label=\"Views\">\n";
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewPanel& view = views[i];
    html += fmt::format(
        "<button type=\"button\" data-view=\"{}\" data-frame=\"{}\" aria-pressed=\"{}\">"
        "<b>{}</b><span>camera {}</span><i style=\"width:{:.0f}%\"></i><span>{}</span>"
        "</button>\n",
        i, view.frame, i == 0 ? "true" : "false", view.frame, view.camera, 100 * view.bar,
        escaped(view.button));
  }
  html += "</div>\n";
  for (std::size_t i = 0; i < views.size(); ++i) html += panel(i, views[i]);
  return html;
}

std::string view_section(const std::vector<ShownView>& views) {
  double highest = 0;
  for (const ShownView& view : views) highest = std::max(highest, view.report.figures.te_mean);
  std::vector<ViewPanel> panels;
  for (const ShownView& view : views) {
    const double te = view.report.figures.te_mean;
    panels.push_back({view.report.frame, view.report.camera, view.picture.photograph,
                      view.picture.drawn.image, "photograph",
                      panels.empty() ? "the worst of all" : "", view.picture.points.pixel,
                      view.picture.errors.color, in_centimetres(view.picture.errors.position),
                      kTeScale, kMeScale, fmt::format("TE {:.1f}", te),
                      highest > 0 ? te / highest : 0, facts(view.report)});
  }
  return view_panels(panels);
}

}  // namespace fovea::app
