#include "app/html_report/view_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/html_report/color_classes.h"
#include "app/html_report/markup.h"

namespace fovea::app {
namespace {

constexpr int kPhotographQuality = 85, kDrawnQuality = 80;

std::string name_of(const ViewReport& view) {
  return fmt::format("frame {}, camera {}", view.frame, view.camera);
}

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

std::string heat_layer(const char* type, const ViewPicture& picture,
                       const std::vector<float>& values, const ErrorScale& scale) {
  return fmt::format(
      "<svg class=\"heat {}\" viewBox=\"-0.5 -0.5 {} {}\" aria-hidden=\"true\">\n{}</svg>\n", type,
      picture.photograph.width, picture.photograph.height,
      heat_paths(picture.points.pixel, values, scale));
}

std::string facts(const ViewReport& view) {
  const ErrorFigures& f = view.figures;
  std::string html = "<dl class=\"facts\">";
  const auto fact = [&](const char* name, const std::string& value) {
    html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, value);
  };
  fact("scored points", count(f.points));
  fact("TE mean", fmt::format("{:.2f}", f.te_mean));
  fact("TE median", fmt::format("{:.2f}", f.te_median));
  fact("within 20", fmt::format("{:.1f}%", 100 * f.te_within_20));
  fact("ME mean", fmt::format("{:.1f} cm", 100 * f.me_mean));
  fact("within 5 cm", fmt::format("{:.1f}%", 100 * f.coverage_5cm));
  fact("PSNR", number(view.pictures.psnr_covered(), 4) + " dB");
  fact("SSIM", number(view.pictures.mean_ssim_covered(), 3));
  return html + "</dl>\n";
}

std::string panel(std::size_t index, const ShownView& view) {
  const ViewPicture& picture = view.picture;
  const std::string name = name_of(view.report);
  const std::vector<float> me = in_centimetres(picture.errors.position);
  std::string html = fmt::format(
      "<article class=\"view\" id=\"view-{}\" data-frame=\"{}\">\n<h3>{}{}</h3>\n", index,
      view.report.frame, static_cast<char>(std::toupper(name[0])) + name.substr(1),
      index == 0 ? " <span class=\"tag\">the worst of all</span>" : "");
  html += fmt::format(
      "<div class=\"compare\" style=\"aspect-ratio:{} / {}\">\n"
      "<img class=\"photograph\" alt=\"Photograph of {}\" src=\"{}\"/>\n"
      "<img class=\"drawn\" alt=\"The map drawn from the same place\" src=\"{}\"/>\n",
      picture.photograph.width, picture.photograph.height, name,
      jpeg_uri(picture.photograph, kPhotographQuality),
      jpeg_uri(picture.drawn.image, kDrawnQuality));
  html += heat_layer("te", picture, picture.errors.color, kTeScale);
  html += heat_layer("me", picture, me, kMeScale);
  html +=
      "<span class=\"side left\">photograph</span><span class=\"side right\">map</span>\n"
      "<div class=\"divider\"></div>\n";
  html += fmt::format(
      "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"1\" "
      "aria-label=\"Share of the photograph, {}\"/>\n</div>\n",
      name);
  html += fmt::format("<div class=\"scale te\">{}</div><div class=\"scale me\">{}</div>\n",
                      legend(kTeScale, shares(picture.errors.color, kTeScale)),
                      legend(kMeScale, shares(me, kMeScale)));
  return html + facts(view.report) + "</article>\n";
}

}  // namespace

std::vector<const ViewReport*> choose_views(const EvaluationReport& report, std::size_t most) {
  std::vector<const ViewReport*> chosen, others;
  const ViewReport* worst = worst_view(report);
  if (worst == nullptr || most == 0) return chosen;
  chosen.push_back(worst);
  for (const ViewReport& view : report.views) {
    if (&view != worst && view.figures.points > 0) others.push_back(&view);
  }
  const std::size_t room = std::min(most - 1, others.size());
  for (std::size_t i = 0; i < room; ++i) {
    // The first and the last among them, where there is room for two.
    chosen.push_back(others[room == 1 ? 0 : i * (others.size() - 1) / (room - 1)]);
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

std::string view_section(const std::vector<ShownView>& views) {
  double highest = 0;
  for (const ShownView& view : views) highest = std::max(highest, view.report.figures.te_mean);
  std::string html = "<div class=\"picker\" role=\"group\" aria-label=\"Views\">\n";
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewReport& view = views[i].report;
    html += fmt::format(
        "<button type=\"button\" data-view=\"{}\" data-frame=\"{}\" aria-pressed=\"{}\">"
        "<b>{}</b><span>camera {}</span><i style=\"width:{:.0f}%\"></i><span>TE {:.1f}</span>"
        "</button>\n",
        i, view.frame, i == 0 ? "true" : "false", view.frame, view.camera,
        highest > 0 ? 100 * view.figures.te_mean / highest : 0, view.figures.te_mean);
  }
  html += "</div>\n";
  for (std::size_t i = 0; i < views.size(); ++i) html += panel(i, views[i]);
  return html;
}

}  // namespace fovea::app
