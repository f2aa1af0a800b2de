#include "tools/paper/bar_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "app/html_report/charts.h"
#include "app/html_report/markup.h"

namespace fovea::paper {
namespace {

constexpr double kWidth = 560, kHeight = 300, kLeft = 64, kRight = 12, kTop = 44, kBottom = 40;
// Distinguishable without colour vision (Okabe and Ito 2008).
constexpr std::array kColors{"#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"};

/// The highest value that is drawn in full.
double top_of(const BarChart& chart) {
  std::vector<double> values;
  for (const BarSeries& series : chart.series) {
    for (const double v : series.values) {
      if (std::isfinite(v)) values.push_back(v);
    }
  }
  if (values.empty()) return 1;
  std::sort(values.begin(), values.end());
  const double limit = chart.cut * values[values.size() / 2];
  const double top = *(std::upper_bound(values.begin(), values.end(), limit) - 1);
  return top > 0 ? top : 1;
}

class Drawing {
 public:
  explicit Drawing(const BarChart& chart) : chart_(chart), top_(1.05 * top_of(chart)) {}

  std::string draw() {
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" font-family=\"sans-serif\" font-size=\"11\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
        kWidth, kHeight);
    text(kWidth / 2, 16, "middle", chart_.title, "font-size=\"13\" font-weight=\"bold\"");
    axis();
    legend();
    for (std::size_t g = 0; g < chart_.groups.size(); ++g) group(g);
    return out_ + "</svg>\n";
  }

 private:
  double y_of(double value) const {
    return kHeight - kBottom - (kHeight - kBottom - kTop) * value / top_;
  }
  void text(double x, double y, const char* anchor, const std::string& what,
            const std::string& more = "") {
    out_ += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"#222\" {}>{}</text>\n", x, y,
        anchor, more, app::escaped(what));
  }
  void axis() {
    const double step = app::round_step(top_, 5);
    for (double v = 0; v <= top_; v += step) {
      out_ += fmt::format(
          "<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>\n",
          kLeft, kWidth - kRight, y_of(v), y_of(v));
      text(kLeft - 6, y_of(v) + 4, "end", fmt::format("{:.4g}", v));
    }
    const double middle = 0.5 * (kTop + kHeight - kBottom);
    text(14, middle, "middle", chart_.y_label,
         fmt::format("transform=\"rotate(-90 14 {:.1f})\"", middle));
  }
  void legend() {
    double x = kLeft;
    for (std::size_t s = 0; s < chart_.series.size(); ++s) {
      out_ += fmt::format("<rect x=\"{:.1f}\" y=\"24\" width=\"10\" height=\"10\" fill=\"{}\"/>\n",
                          x, kColors[s % kColors.size()]);
      text(x + 14, 33, "start", chart_.series[s].name);
      x += 28 + 6.4 * static_cast<double>(chart_.series[s].name.size());
    }
  }
  void group(std::size_t g) {
    const double room = (kWidth - kLeft - kRight) / static_cast<double>(chart_.groups.size());
    const double bar = 0.8 * room / static_cast<double>(chart_.series.size());
    const double left = kLeft + room * static_cast<double>(g) + 0.1 * room;
    text(left + 0.4 * room, kHeight - kBottom + 16, "middle", chart_.groups[g]);
    for (std::size_t s = 0; s < chart_.series.size(); ++s) {
      const double value = chart_.series[s].values[g];
      if (!std::isfinite(value)) continue;
      const double x = left + bar * static_cast<double>(s), y = y_of(std::min(value, top_));
      out_ += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", x,
          y, 0.92 * bar, kHeight - kBottom - y, kColors[s % kColors.size()]);
      if (value > top_) {
        text(x + 0.5 * bar, y - 3, "middle", fmt::format("{:.3g}", value), "font-size=\"9\"");
      }
    }
  }

  const BarChart& chart_;
  double top_;
  std::string out_;
};

}  // namespace

std::string to_svg(const BarChart& chart) {
  for (const BarSeries& series : chart.series) {
    if (series.values.size() != chart.groups.size()) {
      throw std::invalid_argument("a series has not one value a group");
    }
  }
  return Drawing(chart).draw();
}

}  // namespace fovea::paper
