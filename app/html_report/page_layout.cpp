#include "app/html_report/page_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "app/html_report/assets.h"
#include "app/html_report/markup.h"
#include "fovea/platform.h"

namespace fovea::app {
namespace {

/// The template with every {{name}} replaced; std::logic_error for a name that is not given.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text;
  for (std::size_t at = page.find("{{"); at != std::string_view::npos; at = page.find("{{")) {
    const std::size_t end = page.find("}}", at);
    const std::string_view name = page.substr(at + 2, end - at - 2);
    const auto value = std::find_if(values.begin(), values.end(),
                                    [&](const auto& pair) { return pair.first == name; });
    if (value == values.end()) throw std::logic_error("the page asks for " + std::string(name));
    text += page.substr(0, at);
    text += value->second;
    page.remove_prefix(end + 2);
  }
  return text + std::string(page);
}

}  // namespace

std::string card(const std::string& name, const std::string& value, const std::string& more) {
  return fmt::format(
      "<div class=\"card\"><span class=\"name\">{}</span><b>{}</b><span>{}</span></div>\n",
      escaped(name), escaped(value), escaped(more));
}

std::string stage(const std::string& views_html) {
  return "<div class=\"stage\" data-mode=\"slider\"><fieldset class=\"modes\" aria-label=\"Over "
         "the "
         "photograph\">"
         "<label><input type=\"radio\" name=\"mode\" value=\"slider\" "
         "checked=\"checked\"/>map</label>"
         "<label><input type=\"radio\" name=\"mode\" value=\"te\"/>colour error</label>"
         "<label><input type=\"radio\" name=\"mode\" value=\"me\"/>position error</label>"
         "</fieldset>\n" +
         views_html + "</div>\n";
}

std::string chart_panel(const std::string& title, const std::string& note_html,
                        const std::string& chart) {
  if (chart.empty()) return "";
  return fmt::format("<div class=\"panel\"><h3>{}</h3><p class=\"note\">{}</p>\n{}</div>\n",
                     escaped(title), note_html, chart);
}

std::string page_text(const PageLayout& layout) {
  std::string sections, body;
  for (const Part& part : layout.parts) {
    sections += fmt::format("<a href=\"#{}\">{}</a>", part.id, escaped(part.title));
    body += fmt::format("<section class=\"part\" id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", part.id,
                        escaped(part.title), part.html);
  }
  const std::string title =
      escaped(fmt::format("{} against {}", layout.map_name, layout.drive_name));
  return filled(kPageHtml, {{"version", escaped(version())},
                            {"title", title},
                            {"css", std::string(kPageCss)},
                            {"js", std::string(kPageJs)},
                            {"hero", layout.hero_html},
                            {"map", escaped(layout.map_name)},
                            {"drive", escaped(layout.drive_name)},
                            {"protocol", escaped(layout.protocol)},
                            {"cameras", fmt::format("{}", fmt::join(layout.cameras, ", "))},
                            {"frames", escaped(layout.frames_text)},
                            {"warnings", layout.warnings_html},
                            {"explanation", escaped(layout.explanation)},
                            {"cards", layout.cards_html},
                            {"sections", sections},
                            {"defined_in", escaped(layout.defined_in)},
                            {"body", body}});
}

}  // namespace fovea::app
