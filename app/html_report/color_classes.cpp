#include "app/html_report/color_classes.h"

#include <fmt/format.h>

#include "app/html_report/markup.h"

namespace fovea::app {

std::string legend(const ErrorScale& scale, const std::array<double, kErrorClasses>& share) {
  std::string html = fmt::format("<ul class=\"legend heat\"><li>{}:</li>", escaped(scale.name));
  for (std::size_t k = 0; k < kErrorClasses; ++k) {
    std::string bounds;
    if (k == 0) {
      bounds = fmt::format("below {:g}", scale.bounds[0]);
    } else if (k + 1 == kErrorClasses) {
      bounds = fmt::format("{:g} and more", scale.bounds[k - 1]);
    } else {
      bounds = fmt::format("{:g}\xE2\x80\x93{:g}", scale.bounds[k - 1], scale.bounds[k]);
    }
    html += fmt::format("<li><i class=\"swatch h{}\"></i>{}{} <small>{:.0f}%</small></li>", k,
                        escaped(bounds), escaped(scale.unit), 100 * share[k]);
  }
  return html + "</ul>\n";
}

}  // namespace fovea::app
